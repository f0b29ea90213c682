#include "core/prediction/mixer/mixer_net.h"

#include <fmt/format.h>

#include <cmath>

#include "core/prediction/tensors/dct.h"
#include "core/prediction/tensors/dropout.h"
#include "core/prediction/tensors/rotation_tensors.h"

namespace poise::prediction {
namespace {

using torch::Tensor;
using torch::nn::LayerNorm;
using torch::nn::LayerNormOptions;
using torch::nn::Linear;

constexpr double kLeastScale = 1e-3;  // of a number that hardly changes
constexpr double kRootShare = 0.1;    // of the root's error in the loss
constexpr double kNameScale = 0.1;
constexpr double kTiny = 1e-8;

Tensor JointIndices(const NetworkBody& body) {
  return torch::tensor(std::vector<int64_t>(body.joints.begin(), body.joints.end()));
}

}  // namespace

MixerNet::MixerNet(const MixerConfig& config, const NetworkBody& body, EulerMeasure measure)
    : config_(config), measure_(std::move(measure)), joints_(JointIndices(body)) {
  Build();
}

void MixerNet::Build() {
  const int64_t joints = joints_.size(0), tokens = joints + 1;
  const int past = config_.past_frames, future = config_.future_frames, width = config_.width;
  const LayerNormOptions norm(std::vector<int64_t>{width});
  const auto uniform = [](std::vector<int64_t> shape, double most) {
    return torch::empty(shape).uniform_(-most, most);
  };
  const auto silent = [](Linear& linear) {
    torch::nn::init::zeros_(linear->weight);
    torch::nn::init::zeros_(linear->bias);
  };
  scale_ = register_buffer("scale", torch::ones({MixerFeatures(static_cast<int>(joints))}));
  frame_weight_ = register_buffer("frame_weight", torch::ones({future}));
  past_dct_ = register_buffer("past_dct", DctMatrix(past));
  future_dct_ = register_buffer("future_dct", DctMatrix(future));
  joint_in_ = register_module("joint_in", Linear(MixerJointInputs(past), width));
  root_in_ = register_module("root_in", Linear(MixerRootInputs(past), width));
  names_ = register_parameter("names", uniform({tokens, width}, kNameScale));
  for (int i = 0; i < config_.blocks; ++i) {
    const std::string name = fmt::format("block{}_", i);
    blocks_.push_back({.joint_norm = register_module(name + "joint_norm", LayerNorm(norm)),
                       .joints = register_parameter(
                           name + "joints", uniform({config_.groups, tokens, tokens},
                                                    1 / std::sqrt(static_cast<double>(tokens)))),
                       .within_norm = register_module(name + "within_norm", LayerNorm(norm)),
                       .up = register_module(name + "up", Linear(width, config_.hidden)),
                       .down = register_module(name + "down", Linear(config_.hidden, width))});
  }
  out_norm_ = register_module("out_norm", LayerNorm(norm));
  joint_out_ = register_module("joint_out", Linear(width, 3 * future));
  root_out_ = register_module("root_out", Linear(width, 6 * future));
  silent(joint_out_);
  silent(root_out_);
}

// Of all samples at once: few large products instead of many small ones.
Tensor MixerNet::MixJoints(Block& block, const Tensor& h) {
  const int64_t batch = h.size(0), tokens = h.size(1), groups = config_.groups;
  const Tensor grouped = block.joint_norm(h)
                             .view({batch, tokens, groups, -1})
                             .permute({2, 1, 0, 3})
                             .reshape({groups, tokens, -1});
  return torch::bmm(block.joints, grouped)
      .view({groups, tokens, batch, -1})
      .permute({2, 1, 0, 3})
      .reshape({batch, tokens, -1});
}

Tensor MixerNet::Forward(const Tensor& past, const Tensor& still) {
  const int64_t joints = joints_.size(0), future = config_.future_frames;
  const Tensor x = torch::matmul(past_dct_, past / scale_);
  const Tensor motion = x.slice(2, 0, 3 * joints).unflatten(2, {joints, 3}).transpose(1, 2);
  const Tensor pose = still.slice(1, 0, 6 * joints).unflatten(1, {joints, 6});
  const Tensor root =
      torch::cat({x.slice(2, 3 * joints).flatten(1), still.slice(1, 6 * joints)}, 1);
  Tensor h =
      torch::cat({joint_in_(torch::cat({motion.flatten(2), pose}, 2)), root_in_(root).unsqueeze(1)},
                 1) +
      names_;
  for (Block& block : blocks_) {
    h = h + Drop(MixJoints(block, h));
    h = h + Drop(block.down(torch::silu(block.up(block.within_norm(h)))));
  }
  h = out_norm_(h);
  const Tensor turns =
      joint_out_(h.slice(1, 0, joints)).unflatten(2, {future, 3}).transpose(1, 2).flatten(2);
  const Tensor path = root_out_(h.select(1, joints)).unflatten(1, {future, 6});
  return torch::matmul(future_dct_.t(), torch::cat({turns, path}, 2)) * scale_;
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

Tensor MixerNet::Drop(const Tensor& x) const { return Dropout(x, config_.dropout, is_training()); }

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
  Tensor weighted = (errors + kRootShare * root_errors) * frame_weight_;
  if (windows.recorded.defined()) {
    weighted = weighted * windows.recorded.slice(1, config_.past_frames);
  }
  return weighted.mean();
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
