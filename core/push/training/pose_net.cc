#include "core/push/training/pose_net.h"

#include <vector>

#include "core/push/body_joints.h"
#include "core/push/learned/hip_config.h"

namespace poise::push {
namespace {

using torch::Tensor;

// Joints along the tree at the lengths of `body`'s bones. Shapes (people, frames, 22, 3).
Tensor AtBoneLengths(const Tensor& joints, const Tensor& first) {
  std::vector<Tensor> placed(kBodyJoints);
  placed[0] = torch::zeros_like(joints.select(2, 0));
  for (int joint = 1; joint < kBodyJoints; ++joint) {
    const int parent = kBodyParents[joint];
    const Tensor bone = joints.select(2, joint) - joints.select(2, parent);
    const Tensor length =
        (first.select(1, joint) - first.select(1, parent)).norm(2, -1, true).unsqueeze(1);
    placed[joint] = placed[parent] + bone * (length / (bone.square().sum(-1, true) + 1e-10).sqrt());
  }
  return torch::stack(placed, 2);
}

// (people, 2, 2): where the toes are on the floor.
Tensor Toes(const Tensor& first) {
  return torch::stack({first.select(1, kRightToe), first.select(1, kLeftToe)}, 1).slice(2, 0, 2);
}

}  // namespace

Tensor PathFeatures(const PoseBatch& batch, const PoseConfig& config) {
  const int64_t frames = batch.frames();
  const Tensor rate = torch::cat({torch::zeros_like(batch.hip.slice(1, 0, 1)),
                                  (batch.hip.slice(1, 1) - batch.hip.slice(1, 0, -1)) * kFrameRate},
                                 1);
  std::vector<Tensor> features;
  for (const int64_t ahead : {0, config.lookahead / 2, config.lookahead}) {
    const Tensor place = batch.hip.slice(1, ahead, ahead + frames);
    features.push_back(ahead == 0 ? place : place - batch.hip.slice(1, 0, frames));
    features.push_back(rate.slice(1, ahead, ahead + frames));
  }
  features.push_back(config.lean_input ? kLeanScale * batch.lean : torch::zeros_like(batch.lean));
  return torch::cat(features, -1);
}

PoseNetImpl::PoseNetImpl(const PoseConfig& config) : config_(config) {
  cell_ = register_module(
      "cell", torch::nn::GRU(
                  torch::nn::GRUOptions(kPathSize + kBodySize, config.hidden).batch_first(true)));
  pose_ = register_module("pose", torch::nn::Linear(config.hidden, kPoseSize));
  torch::NoGradGuard no_gradient;
  pose_->weight.mul_(0.1);
  pose_->bias.zero_();
}

PosePaths PoseNetImpl::Forward(const PoseBatch& batch) {
  const int64_t frames = batch.frames(), people = batch.hip.size(0);
  const Tensor body = batch.body.unsqueeze(1).expand({-1, frames, -1});
  const Tensor memory = std::get<0>(cell_(torch::cat({PathFeatures(batch, config_), body}, -1)));
  const Tensor pose = pose_(memory), change = kPoseScale * pose;
  const Tensor first =
      torch::cat({torch::zeros({people, 3}, batch.body.options()), batch.body.slice(1, 0, 63)}, 1)
          .reshape({people, kBodyJoints, 3});
  const Tensor moved =
      torch::cat({torch::zeros({people, frames, 3}, change.options()), change.slice(2, 0, 63)}, 2)
          .reshape({people, frames, kBodyJoints, 3});
  return {.joints = AtBoneLengths(first.unsqueeze(1) + moved, first),
          .height = change.select(2, kHeightColumn),
          .swings = pose.slice(2, kSwingColumn, kFootholdColumn),
          .footholds = Toes(first).unsqueeze(1) +
                       change.slice(2, kFootholdColumn, kPoseSize).reshape({people, frames, 2, 2})};
}

}  // namespace poise::push
