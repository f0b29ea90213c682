#include "core/prediction/mixer/mixer_net.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/prediction/tensors/rotation_tensors.h"

namespace poise::prediction {
namespace {

using torch::Tensor;
using torch::nn::LayerNorm;
using torch::nn::LayerNormOptions;
using torch::nn::Linear;

constexpr double kLeastScale = 1e-3;  // of a number that hardly changes
constexpr double kRootShare = 0.1;    // of the root's error in the loss
constexpr double kTiny = 1e-8;

Tensor JointIndices(const NetworkBody& body) {
  return torch::tensor(std::vector<int64_t>(body.joints.begin(), body.joints.end()));
}

}  // namespace

Tensor DctMatrix(int frames) {
  Tensor matrix = torch::empty({frames, frames});
  auto entry = matrix.accessor<float, 2>();
  for (int k = 0; k < frames; ++k) {
    const double weight = std::sqrt((k == 0 ? 1.0 : 2.0) / frames);
    for (int i = 0; i < frames; ++i) {
      entry[k][i] =
          static_cast<float>(weight * std::cos(std::numbers::pi * (i + 0.5) * k / frames));
    }
  }
  return matrix;
}

MixerNet::MixerNet(const MixerConfig& config, const NetworkBody& body, EulerMeasure measure)
    : config_(config), measure_(std::move(measure)), joints_(JointIndices(body)) {
  const int joints = static_cast<int>(body.joints.size());
  Build(MixerFeatures(joints), MixerStillFeatures(joints));
}

void MixerNet::Build(int features, int still_features) {
  const int past = config_.past_frames, future = config_.future_frames, width = config_.width;
  const LayerNormOptions norm(std::vector<int64_t>{width});
  scale_ = register_buffer("scale", torch::ones({features}));
  frame_weight_ = register_buffer("frame_weight", torch::ones({future}));
  past_dct_ = register_buffer("past_dct", DctMatrix(past));
  future_dct_ = register_buffer("future_dct", DctMatrix(future));
  past_in_ = register_module("past_in", Linear(features, width));
  still_in_ = register_module("still_in", Linear(still_features, width));
  for (int i = 0; i < config_.blocks; ++i) {
    const std::string name = fmt::format("block{}_", i);
    blocks_.push_back({.time_norm = register_module(name + "time_norm", LayerNorm(norm)),
                       .time = register_module(name + "time", Linear(past, past)),
                       .pose_norm = register_module(name + "pose_norm", LayerNorm(norm)),
                       .up = register_module(name + "up", Linear(width, config_.hidden)),
                       .down = register_module(name + "down", Linear(config_.hidden, width))});
  }
  out_norm_ = register_module("out_norm", LayerNorm(norm));
  time_out_ = register_module("time_out", Linear(past, future));
  pose_out_ = register_module("pose_out", Linear(width, features));
  torch::nn::init::zeros_(pose_out_->weight);
  torch::nn::init::zeros_(pose_out_->bias);
}

Tensor MixerNet::Forward(const Tensor& past, const Tensor& still) {
  Tensor h = past_in_(torch::matmul(past_dct_, past / scale_)) + still_in_(still).unsqueeze(1);
  for (Block& block : blocks_) {
    h = h + Drop(block.time(block.time_norm(h).transpose(1, 2)).transpose(1, 2));
    h = h + Drop(block.down(torch::silu(block.up(block.pose_norm(h)))));
  }
  h = time_out_(out_norm_(h).transpose(1, 2)).transpose(1, 2);
  return torch::matmul(future_dct_.t(), pose_out_(h)) * scale_;
}

Tensor MixerNet::Changes(const PoseTensors& windows) const {
  const int64_t last = config_.past_frames - 1;
  const Tensor turned = windows.rotations.index_select(2, joints_);
  const Tensor turns = LogMap(Multiply(Conjugate(turned.slice(1, last, last + 1)), turned));
  const Tensor root = windows.rotations.select(2, 0);
  const Tensor root_from_world = Conjugate(root.slice(1, last, last + 1));
  const Tensor path = windows.positions - windows.positions.slice(1, last, last + 1);
  return torch::cat(
      {turns.flatten(2), LogMap(Multiply(root_from_world, root)), Rotate(root_from_world, path)},
      2);
}

Tensor MixerNet::Still(const PoseTensors& windows) const {
  const int64_t last = config_.past_frames - 1;
  const Tensor pose = windows.rotations.select(1, last);
  const Tensor up = torch::tensor({0.0F, 1.0F, 0.0F}).expand({pose.size(0), 3});
  return torch::cat(
      {SixD(pose.index_select(1, joints_)).flatten(1), Rotate(Conjugate(pose.select(1, 0)), up)},
      1);
}

// Rotations of the body's joints after the changes: (batch, frames, joints, 4).
Tensor MixerNet::Turned(const PoseTensors& windows, const Tensor& changes) const {
  const Tensor last =
      windows.rotations.select(1, config_.past_frames - 1).index_select(1, joints_).unsqueeze(1);
  const Tensor turns = changes.slice(2, 0, 3 * joints_.size(0)).unflatten(2, {joints_.size(0), 3});
  return Multiply(last, ExpMap(turns));
}

void MixerNet::Fit(const PoseTensors& windows) {
  const torch::NoGradGuard no_gradient;
  const Tensor changes = Changes(windows);
  scale_.copy_(
      changes.slice(1, 0, config_.past_frames).flatten(0, 1).std(0).clamp_min(kLeastScale));
  const Tensor target = windows.rotations.slice(1, config_.past_frames).index_select(2, joints_);
  const Tensor held = Turned(windows, torch::zeros_like(changes.slice(1, config_.past_frames)));
  const Tensor weight = 1 / measure_.Errors(held, target).mean(0).clamp_min(kTiny);
  frame_weight_.copy_(weight / weight.mean());
}

Tensor MixerNet::Loss(const PoseTensors& windows) {
  const Tensor changes = Changes(windows);
  const Tensor predicted = Forward(changes.slice(1, 0, config_.past_frames), Still(windows));
  const Tensor target = windows.rotations.slice(1, config_.past_frames).index_select(2, joints_);
  const Tensor errors = measure_.SmoothErrors(Turned(windows, predicted), target);
  const Tensor root =
      (predicted - changes.slice(1, config_.past_frames)).slice(2, 3 * joints_.size(0));
  const Tensor root_errors = (root.square().sum(-1) + kTiny).sqrt();
  return ((errors + kRootShare * root_errors) * frame_weight_).mean();
}

PoseTensors MixerNet::Predict(const PoseTensors& windows) {
  const int64_t last = config_.past_frames - 1;
  const PoseTensors past{windows.rotations.slice(1, 0, last + 1),
                         windows.positions.slice(1, 0, last + 1)};
  const Tensor changes = Forward(Changes(past), Still(past));
  const Tensor root = past.rotations.select(1, last).select(1, 0).unsqueeze(1);
  const int64_t first_root = 3 * joints_.size(0);
  Tensor rotations =
      past.rotations.slice(1, last, last + 1).expand({-1, config_.future_frames, -1, -1}).clone();
  rotations.index_copy_(2, joints_, Turned(past, changes));
  rotations.select(2, 0).copy_(
      Multiply(root, ExpMap(changes.slice(2, first_root, first_root + 3))));
  return {rotations, past.positions.slice(1, last, last + 1) +
                         Rotate(root, changes.slice(2, first_root + 3, first_root + 6))};
}

}  // namespace poise::prediction
