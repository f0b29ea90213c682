#ifndef POISE_CORE_SYNTHESIS_VAE_VAE_MODEL_H_
#define POISE_CORE_SYNTHESIS_VAE_VAE_MODEL_H_

#include <memory>
#include <string>

#include "core/artifacts/model_artifact.h"
#include "core/base/random.h"
#include "core/base/status.h"
#include "core/motion/clip.h"
#include "core/synthesis/vae/latent_sampler.h"

namespace poise::synthesis {

/// A trained VAE that makes motions.
/// Constant after construction. Threads: any, each with its own Random.
class VaeModel {
 public:
  /// Rebuilds the network from the card. Errors: kFailedPrecondition WRONG_FAMILY; kInvalidArgument
  /// MALFORMED_CARD, MISSING_TENSOR, WRONG_SHAPE; config errors.
  static StatusOr<std::shared_ptr<const VaeModel>> Create(const artifacts::ModelArtifact& model,
                                                          const LatentSamplerConfig& sampler = {});
  ~VaeModel();

  const motion::MotionSignature& signature() const;
  /// The 16 joints of the body whose clip was learned first, with their own names.
  const motion::SkeletonPtr& skeleton() const;

  /// One new motion, as long as the network estimates. Same state of `random`, same motion.
  /// Errors: kInternal NETWORK_FAILED; kOutOfRange NOT_FINITE.
  StatusOr<motion::Clip> Sample(base::Random& random, const std::string& name) const;

 private:
  class Implementation;
  explicit VaeModel(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_VAE_VAE_MODEL_H_
