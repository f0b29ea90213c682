#ifndef POISE_CORE_CORRECTION_DEBIAS_DEBIAS_PAIRS_H_
#define POISE_CORE_CORRECTION_DEBIAS_DEBIAS_PAIRS_H_

#include <string>
#include <vector>

#include "core/base/run_context.h"
#include "core/correction/correction_config.h"
#include "core/correction/debias/debias_config.h"

namespace poise::correction {

/// A motion as the character imitated it, beside the original: frame i of both is the same time.
/// Both have the character's 16 joints and stand on its floor.
struct DebiasPair {
  motion::Clip imitated, original;
  physics::HumanoidModelPtr body;  ///< the character
  std::string actor = {};          ///< who is left out together
};

struct DebiasClip {
  motion::Clip clip;
  std::string actor = {};
};

/// The correction whose habits a config wants learned.
StatusOr<CorrectionConfig> CorrectionOf(const DebiasConfig& config);

/// Lets a character of each clip's own body imitate it from its first frame to its last. Clips that
/// it did not complete teach nothing and are left out. Progress: clips.
/// Errors: those of JointRoles, Corrector::Create and Corrector::Correct but DIVERGED, with the
/// clip's name.
StatusOr<std::vector<DebiasPair>> MakeDebiasPairs(const std::vector<DebiasClip>& clips,
                                                  const CorrectionConfig& correction,
                                                  const base::RunContext& context);

/// How far apart two motions of a pair are, mean over joints and frames.
struct PairError {
  double joint_rad = 0;  ///< angle between the joints' own rotations, root included
  double root_m = 0;     ///< distance of the roots
};
PairError ErrorBetween(const motion::Clip& motion, const motion::Clip& original);

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_DEBIAS_DEBIAS_PAIRS_H_
