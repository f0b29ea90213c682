#ifndef POISE_CORE_SYNTHESIS_VAE_VAE_SYNTHESIZER_H_
#define POISE_CORE_SYNTHESIS_VAE_VAE_SYNTHESIZER_H_

#include <memory>

#include "core/synthesis/motion_decoder.h"
#include "core/synthesis/synthesizer.h"

namespace poise::synthesis {

/// New motions of the class that a network learned, done by the source's body at the source's rate.
/// Of the source only the body and the rate count: a motion begins where the training clips were
/// put (editing/align.h), facing +Z, and is as long as the network estimates.
class VaeSynthesizer : public Synthesizer {
 public:
  VaeSynthesizer(std::shared_ptr<const MotionDecoder> decoder, const LatentSamplerConfig& config)
      : decoder_(std::move(decoder)), sampler_(decoder_->MakeSampler(config)) {}

  /// Errors: kFailedPrecondition MISSING_ROLES.
  Status Check(const motion::Clip& clip, const motion::JointRoles& roles) const override;
  StatusOr<std::unique_ptr<BoundSynthesizer>> Bind(const Draft& source,
                                                   const motion::JointRoles& roles) const override;

 private:
  const std::shared_ptr<const MotionDecoder> decoder_;
  const LatentSampler sampler_;
};

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_VAE_VAE_SYNTHESIZER_H_
