#include "core/push/ldp/body_net.h"

#include <fmt/format.h>

#include <utility>

namespace poise::push::ldp {
namespace {

using torch::Tensor;

constexpr double kMillimetres = 1000;

// Mean and deviation of columns; one that does not vary has deviation 1.
std::pair<Tensor, Tensor> Statistics(const Tensor& rows) {
  const Tensor deviation = rows.std(0, /*unbiased=*/true);
  return {rows.mean(0), torch::where(deviation > 0, deviation, torch::ones_like(deviation))};
}

// (rows, joints, 3) [mm] in raw features.
Tensor Positions(const Tensor& features, size_t joints) {
  const auto count = static_cast<int64_t>(joints);
  return features.slice(-1, 3, 3 + 3 * count).reshape({features.size(0), count, 3});
}

}  // namespace

BodyNetImpl::BodyNetImpl(const BodyConfig& config, bool pendulum)
    : config_(config), pendulum_(pendulum), parts_(BodyParts(config.parts)) {
  for (size_t part = 0; part < parts_.size(); ++part) {
    const auto name = [&](const char* what) { return fmt::format("{}{}", what, part); };
    const int64_t features = FeatureCount(parts_[part].size());
    const int64_t condition =
        features + (part == 0 ? 0 : 3 * static_cast<int64_t>(parts_[0].size()));
    cvaes_.push_back(register_module(name("cvae"), PartCvae(features, condition, config)));
    if (pendulum) {
      samplers_.push_back(register_module(
          name("sampler"), LatentEncoder(kPendulumFeatures, condition, config, true)));
    }
    mean_.push_back(register_buffer(name("mean"), torch::zeros({features})));
    deviation_.push_back(register_buffer(name("deviation"), torch::ones({features})));
  }
  pendulum_mean_ = register_buffer("pendulum_mean", torch::zeros({kPendulumFeatures}));
  pendulum_deviation_ = register_buffer("pendulum_deviation", torch::ones({kPendulumFeatures}));
}

void BodyNetImpl::SetStatistics(const BodyRows& rows) {
  const torch::NoGradGuard no_gradient;
  const auto set = [](const Tensor& values, Tensor& mean, Tensor& deviation) {
    const auto [new_mean, new_deviation] = Statistics(values);
    mean.copy_(new_mean);
    deviation.copy_(new_deviation);
  };
  for (size_t part = 0; part < parts_.size(); ++part) {
    set(rows.parts[part], mean_[part], deviation_[part]);
  }
  set(rows.pendulum, pendulum_mean_, pendulum_deviation_);
}

Tensor BodyNetImpl::NormalPart(size_t part, const Tensor& rows) const {
  return (rows - mean_[part]) / deviation_[part];
}

Tensor BodyNetImpl::RawPart(size_t part, const Tensor& rows) const {
  return rows * deviation_[part] + mean_[part];
}

Tensor BodyNetImpl::NormalPendulum(const Tensor& rows) const {
  return (rows - pendulum_mean_) / pendulum_deviation_;
}

Tensor BodyNetImpl::Condition(size_t part, const Tensor& now, const Tensor& first_next) const {
  if (part == 0) return now;
  const auto positions = 3 * static_cast<int64_t>(parts_[0].size());
  return torch::cat({now, first_next.slice(-1, 3, 3 + positions)}, -1);
}

Tensor BodyNetImpl::Latent(size_t part, const Tensor& pendulum, const Tensor& condition) {
  if (pendulum_) return samplers_[part](pendulum, condition).mean;
  const auto draw = [&] { return torch::randn({condition.size(0), config_.latent}); };
  // The paper draws thrice for the whole body and takes the mean.
  if (parts_.size() == 1) return (draw() + draw() + draw()) / 3;
  return draw();
}

// (people, kBodyJoints, 3) [m] from normalised features of all parts: each part is moved so that
// its pelvis is the first one's.
Tensor BodyNetImpl::Joints(const std::vector<Tensor>& features) const {
  std::vector<Tensor> joints(kBodyJoints);
  Tensor pelvis;
  for (size_t part = 0; part < parts_.size(); ++part) {
    Tensor placed = Positions(RawPart(part, features[part]), parts_[part].size()) / kMillimetres;
    if (part == 0) pelvis = placed.select(1, 0);
    placed = placed + (pelvis - placed.select(1, 0)).unsqueeze(1);
    for (size_t i = 0; i < parts_[part].size(); ++i) {
      joints[parts_[part][i]] = placed.select(1, static_cast<int64_t>(i));
    }
  }
  return torch::stack(joints, 1);
}

Tensor BodyNetImpl::Rollout(const BodyDrive& drive) {
  const Tensor pendulum = NormalPendulum(drive.pendulum);
  std::vector<Tensor> now;
  for (size_t part = 0; part < parts_.size(); ++part) {
    now.push_back(NormalPart(part, drive.first[part]));
  }
  std::vector<Tensor> poses{Joints(now)};
  for (int64_t frame = 0; frame + 1 < drive.pendulum.size(1); ++frame) {
    const Tensor moves = drive.moves.select(1, frame).unsqueeze(-1) > 0;
    std::vector<Tensor> next(parts_.size());
    for (size_t part = 0; part < parts_.size(); ++part) {
      const Tensor condition = Condition(part, now[part].detach(), next[0]);
      const Tensor latent = Latent(part, pendulum.select(1, frame + 1), condition);
      next[part] = torch::where(moves, cvaes_[part]->decoder(latent, condition), now[part]);
    }
    now = std::move(next);
    poses.push_back(Joints(now));
  }
  return torch::stack(poses, 1);
}

}  // namespace poise::push::ldp
