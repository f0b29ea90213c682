#ifndef POISE_CORE_SYNTHESIS_VAE_VAE_MODEL_H_
#define POISE_CORE_SYNTHESIS_VAE_VAE_MODEL_H_

#include <memory>
#include <string>

#include "core/artifacts/model_artifact.h"
#include "core/base/status.h"
#include "core/motion/clip.h"
#include "core/synthesis/motion_decoder.h"

namespace poise::synthesis {

/// A trained VAE that makes motions, on the 16 joints of the body whose clip was learned first.
class VaeModel : public MotionDecoder {
 public:
  /// Rebuilds the network from the card. Errors: kFailedPrecondition WRONG_FAMILY; kInvalidArgument
  /// MALFORMED_CARD, MISSING_TENSOR, WRONG_SHAPE; config errors.
  static StatusOr<std::shared_ptr<const VaeModel>> Create(const artifacts::ModelArtifact& model);
  ~VaeModel() override;

  const motion::MotionSignature& signature() const override;
  const motion::SkeletonPtr& skeleton() const override;
  LatentSampler MakeSampler(const LatentSamplerConfig& config) const override;
  /// As long as the network estimates.
  StatusOr<motion::Clip> Decode(const Eigen::VectorXd& latent,
                                const std::string& name) const override;

 private:
  class Implementation;
  explicit VaeModel(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_VAE_VAE_MODEL_H_
