#include "core/synthesis/vae/vae_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/learning/nn/guard.h"
#include "core/learning/nn/module_state.h"
#include "core/motion/pose_codec.h"
#include "core/motion/skeleton_json.h"
#include "core/synthesis/vae/vae_config.h"
#include "core/synthesis/vae/vae_net.h"
#include "core/synthesis/vae/vae_tensors_net.h"

namespace poise::synthesis {
namespace {

constexpr motion::RotationCodec kCodec{.representation = motion::RotationRepresentation::kSixD};

// What the card says beside the config.
struct Normalisation {
  RootScale root;
  int frames = 0;
  motion::SkeletonPtr skeleton;
};

StatusOr<Normalisation> ReadNormalisation(const base::Json& json) {
  const auto malformed = [] {
    return base::InvalidArgument("MALFORMED_CARD", "normalisation",
                                 "the card of a VAE needs root, frames and skeleton");
  };
  if (!json.contains("root") || !json.contains("frames") || !json.contains("skeleton") ||
      !json["frames"].is_number_integer()) {
    return malformed();
  }
  Normalisation normalisation;
  normalisation.frames = json["frames"];
  if (normalisation.frames < 1) return malformed();
  POISE_ASSIGN_OR_RETURN(normalisation.root, RootScale::FromJson(json["root"]));
  POISE_ASSIGN_OR_RETURN(normalisation.skeleton, motion::SkeletonFromJson(json["skeleton"]));
  return normalisation;
}

StatusOr<Eigen::MatrixXd> ReadMatrix(const base::TensorFile& file, const std::string& name,
                                     int columns) {
  POISE_ASSIGN_OR_RETURN(const base::TensorRecord* record, file.Find(name));
  const int64_t rows = record->shape.empty() ? 0 : record->shape[0];
  POISE_ASSIGN_OR_RETURN(const std::vector<float> values,
                         file.Floats(name, std::vector<int64_t>{rows, columns}));
  if (rows == 0) {
    return base::InvalidArgument("WRONG_SHAPE", "", fmt::format("tensor '{}' is empty", name));
  }
  using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::MatrixXd(Eigen::Map<const RowMajor>(values.data(), rows, columns).cast<double>());
}

Status NotFinite() {
  return base::MakeError(absl::StatusCode::kOutOfRange, "NOT_FINITE", "",
                         "the VAE made a number that is none");
}

}  // namespace

class VaeModel::Implementation {
 public:
  motion::MotionSignature signature;
  Normalisation normalisation;
  std::shared_ptr<VaeNet> net;
  Eigen::MatrixXd means, variances;  // (motions, latent) of the training clips
  uint64_t seed = 0;

  StatusOr<motion::Clip> Decode(const Eigen::VectorXd& latent, const std::string& name) const {
    const torch::NoGradGuard no_gradient;
    torch::Tensor z = torch::empty({1, latent.size()});
    std::copy(latent.begin(), latent.end(), z.data_ptr<float>());
    const double length = net->EstimateLength(z).item<double>();
    if (!std::isfinite(length)) return NotFinite();
    const int frames = static_cast<int>(
        std::clamp<double>(std::round(length), 1, static_cast<double>(normalisation.frames)));
    const torch::Tensor poses = net->Decode(z, frames).squeeze(0);
    if (!torch::isfinite(poses).all().item<bool>()) return NotFinite();
    return DecodePoses(UnstackMotion(poses, frames, normalisation.root), kCodec, name,
                       normalisation.skeleton, signature.frame_rate);
  }
};

VaeModel::VaeModel(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
VaeModel::~VaeModel() = default;

StatusOr<std::shared_ptr<const VaeModel>> VaeModel::Create(const artifacts::ModelArtifact& model) {
  if (model.card.family != "vae") {
    return base::FailedPrecondition(
        "WRONG_FAMILY", "model",
        fmt::format("a model of family '{}' makes no motions, expected 'vae'", model.card.family));
  }
  VaeConfig config;
  POISE_RETURN_IF_ERROR(base::FieldsFromJson(model.card.config, config.Fields()));
  auto parts = std::make_unique<Implementation>();
  parts->signature = model.card.signature;
  parts->seed = model.card.seed;
  POISE_ASSIGN_OR_RETURN(parts->normalisation, ReadNormalisation(model.card.normalisation));
  POISE_ASSIGN_OR_RETURN(parts->means,
                         ReadMatrix(model.weights, "latents/mean", config.net.latent));
  POISE_ASSIGN_OR_RETURN(const Eigen::MatrixXd log_variances,
                         ReadMatrix(model.weights, "latents/log_variance", config.net.latent));
  parts->variances = log_variances.array().exp();
  POISE_RETURN_IF_ERROR(learning::Guard("VAE", [&]() -> Status {
    parts->net =
        std::make_shared<VaeNet>(config.net, parts->normalisation.frames, parts->signature.width());
    parts->net->eval();
    return learning::LoadState(model.weights, "net/", *parts->net);
  }));
  return std::shared_ptr<const VaeModel>(new VaeModel(std::move(parts)));
}

const motion::MotionSignature& VaeModel::signature() const { return implementation_->signature; }
const motion::SkeletonPtr& VaeModel::skeleton() const {
  return implementation_->normalisation.skeleton;
}

LatentSampler VaeModel::MakeSampler(const LatentSamplerConfig& config) const {
  return LatentSampler(implementation_->means, implementation_->variances, config,
                       implementation_->seed);
}

StatusOr<motion::Clip> VaeModel::Decode(const Eigen::VectorXd& latent,
                                        const std::string& name) const {
  return learning::Guard("VAE", [&] { return implementation_->Decode(latent, name); });
}

}  // namespace poise::synthesis
