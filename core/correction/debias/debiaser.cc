#include "core/correction/debias/debiaser.h"

#include <fmt/format.h>

#include <utility>

#include "core/correction/debias/foot_hold.h"
#include "core/math/low_pass.h"
#include "core/motion/motion_signature.h"

namespace poise::correction {
namespace {

constexpr float kLeak = 0.01f;  // of LeakyReLU

StatusOr<Eigen::RowVectorXf> ReadRow(const base::TensorFile& weights, const std::string& name,
                                     int64_t columns) {
  POISE_ASSIGN_OR_RETURN(const std::vector<float> values,
                         weights.Floats(name, std::vector<int64_t>{columns}));
  return Eigen::RowVectorXf(Eigen::Map<const Eigen::RowVectorXf>(values.data(), columns));
}

}  // namespace

StatusOr<std::shared_ptr<const Debiaser>> Debiaser::Create(const artifacts::ModelArtifact& model) {
  if (model.card.family != kFamily) {
    return base::FailedPrecondition(
        "WRONG_FAMILY", "model",
        fmt::format("a model of family '{}' debiases no motions, expected '{}'", model.card.family,
                    kFamily));
  }
  std::shared_ptr<Debiaser> debiaser(new Debiaser());
  POISE_RETURN_IF_ERROR(base::FieldsFromJson(model.card.config, debiaser->config_.Fields()));
  debiaser->signature_ = model.card.signature;
  POISE_RETURN_IF_ERROR(debiaser->Load(model.weights));
  return debiaser;
}

Status Debiaser::Load(const base::TensorFile& weights) {
  int64_t inputs = InputWidth(config_.input);
  POISE_ASSIGN_OR_RETURN(mean_, ReadRow(weights, "input.mean", inputs));
  POISE_ASSIGN_OR_RETURN(scale_, ReadRow(weights, "input.scale", inputs));
  POISE_ASSIGN_OR_RETURN(size_, ReadRow(weights, "output.size", kCorrectionWidth));
  for (int i = 0; i <= config_.layers; ++i) {
    const int64_t outputs = i < config_.layers ? config_.hidden : kCorrectionWidth;
    const std::string name = fmt::format("layer{}", i);
    POISE_ASSIGN_OR_RETURN(const std::vector<float> weight,
                           weights.Floats(name + ".weight", std::vector<int64_t>{outputs, inputs}));
    Layer& layer = layers_.emplace_back();
    layer.weight = Eigen::Map<const FrameRows>(weight.data(), outputs, inputs).transpose();
    POISE_ASSIGN_OR_RETURN(layer.bias, ReadRow(weights, name + ".bias", outputs));
    inputs = outputs;
  }
  return absl::OkStatus();
}

Status Debiaser::CheckFits(const std::string& model, const motion::Clip& clip,
                           const motion::JointRoles& roles) const {
  return motion::CheckFits(signature_, model, clip, roles);
}

StatusOr<motion::Clip> Debiaser::Apply(const motion::Clip& imitated,
                                       const physics::HumanoidModel& body) const {
  if (imitated.num_joints() * 6 + 3 != kCorrectionWidth) {
    return base::InvalidArgument(
        "WRONG_SHAPE", "clip",
        fmt::format("clip '{}' has {} joints, expected the 16 of the character", imitated.name(),
                    imitated.num_joints()));
  }
  const FrameRows correction = Correction(imitated);
  if (!correction.allFinite()) {
    return base::MakeError(absl::StatusCode::kOutOfRange, "NOT_FINITE", "",
                           "the debiasing network made a number that is none");
  }
  // Bending a leg to where it is would still round.
  if (correction.isZero(0)) return imitated;
  motion::Clip debiased = ApplyCorrection(imitated, correction);
  if (!config_.hold.enabled) return debiased;
  return HoldFeet(std::move(debiased), imitated, body, config_.hold);
}

FrameRows Debiaser::Correction(const motion::Clip& imitated) const {
  FrameRows rows = MakeFrameRows(imitated, config_.input);
  rows = ((rows.rowwise() - mean_).array().rowwise() / scale_.array())
             .cwiseMax(-kInputLimit)
             .cwiseMin(kInputLimit)
             .matrix();
  for (size_t i = 0; i < layers_.size(); ++i) {
    rows = ((rows * layers_[i].weight).rowwise() + layers_[i].bias).eval();
    if (i + 1 < layers_.size()) rows = rows.cwiseMax(kLeak * rows).eval();
  }
  rows.array().rowwise() *= size_.array();
  if (config_.cutoff_hz > 0) Smooth(rows, imitated.frame_rate());
  return rows;
}

void Debiaser::Smooth(FrameRows& rows, double frame_rate) const {
  std::vector<double> channel(rows.rows());
  for (Eigen::Index column = 0; column < rows.cols(); ++column) {
    for (Eigen::Index f = 0; f < rows.rows(); ++f) channel[f] = rows(f, column);
    math::LowPassZeroPhase(channel, frame_rate, config_.cutoff_hz);
    for (Eigen::Index f = 0; f < rows.rows(); ++f) {
      rows(f, column) = static_cast<float>(channel[f]);
    }
  }
}

}  // namespace poise::correction
