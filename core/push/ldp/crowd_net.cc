#include "core/push/ldp/crowd_net.h"

#include <vector>

#include "core/push/body_joints.h"

namespace poise::push::ldp {
namespace {

using torch::Tensor;

// Limits of rates: x, y [m/s], theta, phi [rad/s], as the authors' programs have them.
constexpr double kFree = 1e6;
constexpr double kSingleLeast[] = {-kFree, -kFree, -3.9342, -4.4811};
constexpr double kSingleGreatest[] = {kFree, kFree, 3.8116, 6.7407};
constexpr double kSeveralLeast[] = {-0.6360, -1.3357, -1.8478, -1.7310};
constexpr double kSeveralGreatest[] = {3.0901, 1.5026, 1.6746, 1.1985};
constexpr double kLargestLean = 1.571;

Tensor Row(const double (&values)[4], const Tensor& like) {
  return torch::tensor(torch::ArrayRef<double>(values, 4), like.options());
}

// Mean over people and frames of each take, then over takes. `values`, `mask` (takes, people,
// frames).
Tensor MeanOverTakes(const Tensor& values, const Tensor& mask) {
  return ((values * mask).sum({1, 2}) / mask.sum({1, 2}).clamp_min(1)).mean();
}

/// All people of all takes as one table.
PendulumTensors Flat(const PendulumTensors& states) {
  return {states.position.reshape({-1, 4}), states.velocity.reshape({-1, 4}),
          states.rod.reshape({-1})};
}

// What is the same in every frame.
struct Scene {
  explicit Scene(const TakeTensors& takes)
      : alone(takes.people() == 1),
        least(Row(alone ? kSingleLeast : kSeveralLeast, takes.mass)),
        greatest(Row(alone ? kSingleGreatest : kSeveralGreatest, takes.mass)),
        mass(takes.mass.reshape({-1})),
        pushed(torch::zeros_like(takes.mass)) {
    pushed.select(1, 0).fill_(1);
  }

  bool alone;
  Tensor least, greatest;
  Tensor mass;    // (everybody)
  Tensor pushed;  // (takes, people)
};

// (takes, people, 4) in one frame.
Tensor PushIn(const TakeTensors& takes, const Scene& scene, int64_t frame,
              const PendulumTensors& states) {
  if (frame >= takes.push.size(1)) return torch::zeros_like(states.position);
  const PendulumTensors first{states.position.select(1, 0), states.velocity.select(1, 0),
                              states.rod.select(1, 0)};
  const Tensor force =
      takes.push.select(1, frame) + AtRodEnd(first, takes.hip_push.select(1, frame));
  return force.unsqueeze(1) * scene.pushed.unsqueeze(-1);
}

}  // namespace

CrowdNetImpl::CrowdNetImpl(const BalanceConfig& balance_config,
                           const InteractionConfig& interaction_config)
    : config_(balance_config) {
  balance = register_module("balance", Balance(balance_config));
  interaction = register_module("interaction", Interaction(interaction_config));
}

CrowdPaths CrowdNetImpl::Rollout(const TakeTensors& takes, int64_t frames) {
  const Scene scene(takes);
  const auto shape = takes.mass.sizes();
  const auto first = [](const Tensor& recorded) { return recorded.select(2, 0); };
  PendulumTensors states{first(takes.recorded.position), first(takes.recorded.velocity),
                         first(takes.recorded.rod)};
  BalanceMemory memory = balance->Begin(Flat(states));
  Tensor active = config_.wait ? scene.pushed > 0 : torch::ones_like(scene.pushed) > 0;
  std::vector<Tensor> positions{states.position}, velocities{states.velocity}, rods{states.rod};
  std::vector<Tensor> activities{active};
  for (int64_t frame = 0; frame + 1 < frames; ++frame) {
    const Tensor push = PushIn(takes, scene, frame, states);
    const Tensor others =
        scene.alone ? torch::zeros_like(push) : interaction->Forces(states, takes.there());
    active = active | (others.abs().sum(-1) > 0);
    const Tensor acts = active.reshape({-1, 1});

    const PendulumTensors now = Flat(states);
    BalanceMemory next_memory = memory;
    const BalanceForces own = balance->Forces(now, scene.mass, next_memory);
    // Who stands and waits remembers nothing of it.
    memory.hidden = torch::where(acts, next_memory.hidden, memory.hidden);
    memory.cell = torch::where(acts, next_memory.cell, memory.cell);
    memory.error = next_memory.error;

    Tensor control = own.control;
    if (scene.alone && config_.push_alone) {
      control = torch::where((takes.push_frames > frame).unsqueeze(-1), torch::zeros_like(control),
                             control);
    }
    const PendulumTensors longer{now.position, now.velocity,
                                 balance->NextRod(now, scene.mass, own.self)};
    const Tensor force = push.reshape({-1, 4}) + others.reshape({-1, 4}) + control;
    Tensor velocity = now.velocity + kFrameTime * Accelerations(longer, scene.mass, force);
    velocity = torch::minimum(torch::maximum(velocity, scene.least), scene.greatest);
    const Tensor moved = now.position + kFrameTime * velocity;
    const Tensor position =
        torch::cat({moved.slice(1, 0, 2), moved.slice(1, 2).clamp(-kLargestLean, kLargestLean)}, 1);
    const auto shaped = [&](const Tensor& next, const Tensor& before) {
      return torch::where(acts.reshape({shape[0], shape[1], 1}),
                          next.reshape({shape[0], shape[1], -1}),
                          before.reshape({shape[0], shape[1], -1}));
    };
    states = {shaped(position, now.position), shaped(velocity, now.velocity),
              shaped(longer.rod, now.rod).squeeze(-1)};
    positions.push_back(states.position);
    velocities.push_back(states.velocity);
    rods.push_back(states.rod);
    activities.push_back(active);
  }
  return {{torch::stack(positions, 2), torch::stack(velocities, 2), torch::stack(rods, 2)},
          torch::stack(activities, 2).to(takes.mass.dtype())};
}

CrowdErrors ErrorsOf(const CrowdPaths& paths, const TakeTensors& takes) {
  const auto frames = paths.states.rod.size(2);
  const auto cut = [&](const Tensor& whole) { return whole.slice(2, 0, frames); };
  const Tensor mask = cut(takes.mask);
  const Tensor place = (paths.states.position - cut(takes.recorded.position)).abs().sum(-1);
  const Tensor rate = (paths.states.velocity - cut(takes.recorded.velocity)).abs();
  const Tensor phi_rate =
      takes.people() == 1 ? paths.states.velocity.select(-1, 3).abs() : rate.select(-1, 3);
  const Tensor first_rod = takes.recorded.rod.select(2, 0).unsqueeze(2).expand_as(mask);
  const Tensor ends = RodEnds(paths.states.position, first_rod, takes.cart_height.unsqueeze(2));
  return {MeanOverTakes(place + rate.slice(-1, 0, 3).sum(-1), mask), MeanOverTakes(phi_rate, mask),
          MeanOverTakes((paths.states.rod - cut(takes.recorded.rod)).abs(), mask),
          MeanOverTakes(((ends - cut(takes.hip)).square().sum(-1) + 1e-10).sqrt(), mask)};
}

}  // namespace poise::push::ldp
