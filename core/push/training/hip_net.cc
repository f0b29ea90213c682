#include "core/push/training/hip_net.h"

#include <utility>

#include "core/push/body_joints.h"

namespace poise::push {

using torch::Tensor;

struct HipNetImpl::State {
  Tensor hip, hip_rate, lean, lean_rate;  // (takes, people, 2)
};

HipNetImpl::HipNetImpl(const HipConfig& config) : config_(config) {
  message_in_ = register_module("message_in", torch::nn::Linear(kPairSize, config.message_hidden));
  message_out_ =
      register_module("message_out", torch::nn::Linear(config.message_hidden, config.message));
  cell_ = register_module(
      "cell", torch::nn::GRUCell(kOwnSize + config.message + kContextSize, config.hidden));
  drive_ = register_module("drive", torch::nn::Linear(config.hidden, kDriveSize));
  // Nobody moves before it has learned to.
  torch::NoGradGuard no_gradient;
  drive_->weight.mul_(0.1);
  drive_->bias.zero_();
}

// (takes, people, message): the sum of what others within reach say. `pairs` is 0 for a person and
// itself, and for people who are not there.
Tensor HipNetImpl::Messages(const TakeBatch& batch, const State& state, const Tensor& pairs) {
  const Tensor place = batch.place + state.hip;
  const Tensor away = place.unsqueeze(2) - place.unsqueeze(1);  // (takes, people, people, 2)
  const Tensor speed = state.hip_rate.unsqueeze(2) - state.hip_rate.unsqueeze(1);
  const Tensor distance = (away.square().sum(-1, true) + 1e-6).sqrt();
  const Tensor own = torch::cat({kLeanScale * state.lean, state.hip_rate}, -1);
  const auto people = batch.people();
  const Tensor mine = own.unsqueeze(2).expand({-1, -1, people, -1});
  const Tensor theirs = own.unsqueeze(1).expand({-1, people, -1, -1});
  const Tensor input = torch::cat({away, speed, distance, mine, theirs}, -1);
  const Tensor nearness = torch::relu(1 - (distance / config_.reach_m).square());
  const Tensor message = message_out_(torch::tanh(message_in_(input)));
  return (message * nearness.square() * pairs).sum(2);
}

HipPaths HipNetImpl::Rollout(const TakeBatch& batch, int64_t frames) {
  const auto takes = batch.hip.size(0), people = batch.people();
  const Tensor zero = torch::zeros({takes, people, 2}, batch.hip.options());
  State state{zero, zero, zero, zero};
  Tensor memory = torch::zeros({takes * people, config_.hidden}, batch.hip.options());
  const Tensor there = batch.mask.select(2, 0);  // (takes, people)
  const Tensor others = 1 - torch::eye(people, batch.hip.options());
  const Tensor pairs = (there.unsqueeze(1) * there.unsqueeze(2) * others).unsqueeze(-1);
  const Tensor silence = torch::zeros({takes, people, config_.message}, batch.hip.options());
  const bool talk = config_.messages && people > 1;
  std::vector<Tensor> hips{state.hip}, leans{state.lean};
  for (int64_t frame = 0; frame + 1 < frames; ++frame) {
    const Tensor push = batch.push.select(2, frame);
    const Tensor message = talk ? Messages(batch, state, pairs) : silence;
    const Tensor input = torch::cat({state.hip_rate, state.hip, kLeanScale * state.lean,
                                     state.lean_rate, push, message, batch.context},
                                    -1);
    memory = cell_(input.reshape({takes * people, -1}), memory);
    const Tensor drive = drive_(memory).reshape({takes, people, kDriveSize});
    const Tensor hip_acceleration = kHipAcceleration * drive.slice(-1, 0, 2) + push / kPushScale;
    state.hip_rate = state.hip_rate + kFrameTime * hip_acceleration;
    state.hip = state.hip + kFrameTime * state.hip_rate;
    state.lean_rate =
        state.lean_rate + kFrameTime * kLeanAcceleration * drive.slice(-1, 2, kDriveSize);
    state.lean = state.lean + kFrameTime * state.lean_rate;
    hips.push_back(state.hip);
    leans.push_back(state.lean);
  }
  return {torch::stack(hips, 2), torch::stack(leans, 2)};
}

}  // namespace poise::push
