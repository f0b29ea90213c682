#ifndef POISE_CORE_SYNTHESIS_NOISE_NOISE_SYNTHESIZER_H_
#define POISE_CORE_SYNTHESIS_NOISE_NOISE_SYNTHESIZER_H_

#include <memory>
#include <vector>

#include "core/base/config_fields.h"
#include "core/synthesis/synthesizer.h"

namespace poise::synthesis {

struct NoiseConfig {
  double fraction = 0.01;  ///< [0, 10] of each dimension's standard deviation (reference sec. 6)

  std::vector<base::Field> Fields();
};

/// Variants with zero-mean Gaussian noise on every pose, independent from frame to frame: the
/// baseline that augmentation is compared with. Its standard deviation is a fraction of the clip's
/// own along each dimension: the root position's three axes, and per joint the three axes of the
/// rotation vector from the joint's mean rotation to its rotation. The draw is a rotation vector in
/// the joint's frame, rotation * exp(draw). What does not move in the clip stays bit for bit.
/// Source: reference sec. 6 (in pose space for every predictor; the authors' program adds it to DCT
/// coefficients, which reaches one predictor only).
class NoiseSynthesizer : public Synthesizer {
 public:
  explicit NoiseSynthesizer(const NoiseConfig& config) : config_(config) {}

  Status Check(const motion::Clip& clip, const motion::JointRoles& roles) const override;
  StatusOr<std::unique_ptr<BoundSynthesizer>> Bind(const Draft& source,
                                                   const motion::JointRoles& roles) const override;

 private:
  NoiseConfig config_;
};

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_NOISE_NOISE_SYNTHESIZER_H_
