#ifndef POISE_CORE_SYNTHESIS_SYNTHESIZER_REGISTRY_H_
#define POISE_CORE_SYNTHESIS_SYNTHESIZER_REGISTRY_H_

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/config_fields.h"
#include "core/base/status.h"
#include "core/synthesis/motion_decoder.h"
#include "core/synthesis/synthesizer.h"

namespace poise::synthesis {

/// What configures the steps of a method.
struct SynthesisOptions {
  std::string action_class = "kick";
  std::string preset = "recommended";
  base::Overrides overrides =
      {};  ///< {"ik.angle": "0.5"}: each key begins with the step it belongs to
  std::shared_ptr<const MotionDecoder> decoder = nullptr;  ///< what step "vae" needs
  /// The decoder comes later: settings are checked, and step "vae" makes no synthesizer.
  bool check_only = false;
};

/// One step of a method, ready to bind.
struct MethodStep {
  std::string name;
  std::unique_ptr<Synthesizer> synthesizer;
};

inline constexpr int kMaxMethodSteps = 8;

/// Names of all steps, in the order of the table.
std::vector<std::string> MethodStepNames();

/// Builds the steps of a method: names joined by '+' ("ik+timewarp"), applied left to right.
/// Errors: kInvalidArgument UNKNOWN_METHOD (naming the known steps and the nearest),
/// TOO_MANY_STEPS, MISSING_MODEL (step "vae" without a decoder, unless only checked),
/// UNKNOWN_ACTION_CLASS, UNKNOWN_PRESET, UNKNOWN_CONFIG_KEY and the other config errors.
StatusOr<std::vector<MethodStep>> CreateMethod(std::string_view method,
                                               const SynthesisOptions& options);

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_SYNTHESIZER_REGISTRY_H_
