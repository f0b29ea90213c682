#ifndef POISE_CORE_SYNTHESIS_MOTION_DECODER_H_
#define POISE_CORE_SYNTHESIS_MOTION_DECODER_H_

#include <Eigen/Core>
#include <string>

#include "core/base/status.h"
#include "core/motion/clip.h"
#include "core/motion/motion_signature.h"
#include "core/synthesis/vae/latent_sampler.h"

namespace poise::synthesis {

/// A trained network that makes whole motions from latent vectors, behind an interface without
/// LibTorch.
/// Constant after construction. Threads: any.
class MotionDecoder {
 public:
  virtual ~MotionDecoder() = default;
  virtual const motion::MotionSignature& signature() const = 0;
  /// The body of the motions it makes.
  virtual const motion::SkeletonPtr& skeleton() const = 0;
  /// Draws latent vectors around the motions that it learned from.
  virtual LatentSampler MakeSampler(const LatentSamplerConfig& config) const = 0;
  /// Errors: kInternal NETWORK_FAILED; kOutOfRange NOT_FINITE.
  virtual StatusOr<motion::Clip> Decode(const Eigen::VectorXd& latent,
                                        const std::string& name) const = 0;
};

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_MOTION_DECODER_H_
