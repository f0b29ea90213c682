#ifndef POISE_CORE_SYNTHESIS_TIMEWARP_TIMEWARP_SYNTHESIZER_H_
#define POISE_CORE_SYNTHESIS_TIMEWARP_TIMEWARP_SYNTHESIZER_H_

#include <memory>
#include <vector>

#include "core/base/config_fields.h"
#include "core/synthesis/synthesizer.h"

namespace poise::synthesis {

struct TimewarpConfig {
  double factor_low = 0.9;   ///< [0.1, 10] of the duration (MotionAug sec. 4.3: 10 % shorter ...)
  double factor_high = 1.1;  ///< [factor_low, 10] (... to 10 % longer)

  std::vector<base::Field> Fields();
  /// Errors: kInvalidArgument CONFIG_VALUE_OUT_OF_RANGE where the low is above the high.
  Status Validate() const;
};

/// Variants that are faster or slower: the whole clip resampled by one uniform factor, to a whole
/// number of frames at the clip's own rate.
/// Source: MotionAug sec. 4.3; reference sec. 6 (the authors' program shifts the keyframe instead,
/// with the ratio inverted).
/// Errors of Check: kFailedPrecondition CLIP_TOO_SHORT.
class TimewarpSynthesizer : public Synthesizer {
 public:
  static constexpr int kMinFrames = 2;

  explicit TimewarpSynthesizer(const TimewarpConfig& config) : config_(config) {}

  Status Check(const motion::Clip& clip, const motion::JointRoles& roles) const override;
  StatusOr<std::unique_ptr<BoundSynthesizer>> Bind(const Draft& source,
                                                   const motion::JointRoles& roles) const override;

 private:
  TimewarpConfig config_;
};

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_TIMEWARP_TIMEWARP_SYNTHESIZER_H_
