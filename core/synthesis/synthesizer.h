#ifndef POISE_CORE_SYNTHESIS_SYNTHESIZER_H_
#define POISE_CORE_SYNTHESIS_SYNTHESIZER_H_

#include <memory>
#include <optional>

#include "core/api/augment_spec.h"
#include "core/base/random.h"
#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/motion/clip.h"
#include "core/motion/joint_roles.h"

namespace poise::synthesis {

/// A variant while it passes through the steps of a method.
struct Draft {
  motion::Clip clip;
  std::optional<api::IkOutcome> ik;  ///< of the last step that was IK; a mirror mirrors it
};

/// A synthesizer that has studied one source (keyframe, limb, ...) and now makes variants.
/// Refers to the source and the synthesizer, which must outlive it.
/// Threads: Sample may be called from several threads, each with its own Random.
class BoundSynthesizer {
 public:
  virtual ~BoundSynthesizer() = default;
  /// Same state of `random`, same draft.
  virtual StatusOr<Draft> Sample(base::Random& random, const base::RunContext& context) const = 0;
};

/// One way to make variants of a clip: "ik", "timewarp", "noise", "mirror", later "vae".
/// Constant after construction; built by synthesis/synthesizer_registry.h.
class Synthesizer {
 public:
  virtual ~Synthesizer() = default;
  /// Whether a clip has what this way needs, cheaply and before any work.
  /// Errors: kFailedPrecondition when the clip lacks roles or length.
  virtual Status Check(const motion::Clip& clip, const motion::JointRoles& roles) const = 0;
  /// Prepares for variants of `source`: a clip, or the draft of an earlier step.
  /// Errors: those of Check.
  virtual StatusOr<std::unique_ptr<BoundSynthesizer>> Bind(
      const Draft& source, const motion::JointRoles& roles) const = 0;
};

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_SYNTHESIZER_H_
