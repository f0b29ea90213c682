#include "core/push/ldp/interaction.h"

#include "core/push/body_joints.h"

namespace poise::push::ldp {
namespace {

using torch::Tensor;
using torch::nn::Linear;

// The authors' statistics of inputs and outputs (constants/interaction.json of the data set). The
// least lateral force comes from a test take; it is a limit that nothing reaches.
constexpr double kInputMean[] = {-0.42954, 0.02033, 0.00232, 0.00247, 0.08398,
                                 0.05574,  0.00322, 0.00527, 0.00518, -0.00056};
constexpr double kInputDeviation[] = {0.18877, 0.22593, 0.51113, 0.26659, 0.07804,
                                      0.05817, 0.03710, 0.03281, 0.47666, 0.29129};
constexpr double kForceMean[] = {-46.7739, 6.6148, -43.1003, -8.8489};
constexpr double kForceDeviation[] = {272.0406, 132.516, 164.427, 114.3698};
constexpr double kForceLeast[] = {-2507.4078, -883.5459, -2106.6155, -1133.9879};
constexpr double kForceGreatest[] = {1587.3721, 1399.2835, 1323.8701, 832.9387};

template <size_t size>
Tensor Row(const double (&values)[size], const Tensor& like) {
  return torch::tensor(torch::ArrayRef<double>(values, size), like.options());
}

Tensor Length(const Tensor& vectors) { return (vectors.square().sum(-1) + 1e-12).sqrt(); }

Tensor Planar(const Tensor& coordinates) { return coordinates.slice(-1, 0, 2); }

// Who stands at `index` of a flat table of people.
PendulumTensors PeopleAt(const PendulumTensors& states, const Tensor& index) {
  return {states.position.reshape({-1, 4}).index_select(0, index),
          states.velocity.reshape({-1, 4}).index_select(0, index),
          states.rod.reshape({-1}).index_select(0, index)};
}

}  // namespace

Tensor PotentialForce(const PairTensors& pairs, const InteractionConfig& config) {
  const Tensor away = Planar(pairs.own.position) - Planar(pairs.other.position);
  const Tensor step = kFrameTime * (Planar(pairs.other.velocity) - Planar(pairs.own.velocity));
  const Tensor next = away - step;
  const Tensor distance = Length(away), next_distance = Length(next);
  const Tensor both = distance + next_distance;
  const Tensor b = 0.5 * (both.square() - step.square().sum(-1)).clamp_min(1e-12).sqrt();
  // F = -grad V with V = u exp(-b / sigma) and grad b = both grad(both) / (4 b).
  const Tensor gradient = (both / (4 * b)).unsqueeze(-1) *
                          (away / distance.unsqueeze(-1) + next / next_distance.unsqueeze(-1));
  const Tensor slope = config.potential / config.potential_m * (-b / config.potential_m).exp();
  return slope.unsqueeze(-1) * gradient;
}

Tensor AngularSigns(const PairTensors& pairs, const InteractionConfig& config) {
  const Tensor own = pairs.own.position.slice(-1, 2), other = pairs.other.position.slice(-1, 2);
  const Tensor behind = Planar(pairs.own.position) > Planar(pairs.other.position);
  // The paper's two tables in words: somebody is pressed on when the neighbour leans towards them
  // or they themselves lean against it.
  const Tensor more = ((other >= config.upright) | (own <= -config.upright)).to(own.dtype());
  const Tensor less = -((own >= config.upright) | (other <= -config.upright)).to(own.dtype());
  const Tensor theta = torch::where(behind.select(-1, 0), more.select(-1, 0), less.select(-1, 0));
  const Tensor phi = torch::where(behind.select(-1, 1), less.select(-1, 1), more.select(-1, 1));
  return torch::stack({theta, phi}, -1);
}

Tensor BasicForces(const PairTensors& pairs, const InteractionConfig& config) {
  const Tensor distance = Length(Planar(pairs.own.position) - Planar(pairs.other.position));
  const Tensor speed = Length(Planar(pairs.other.velocity) - Planar(pairs.own.velocity));
  const Tensor nearness = (0.5 + (0.5 - distance) * 0.5 / (0.5 - 0.1)).clamp(0, 1);
  const Tensor weight = (speed.clamp(0.8, 10) * nearness).unsqueeze(-1);
  const Tensor torque = torch::tensor({config.theta_torque, config.phi_torque}, distance.options());
  return weight *
         torch::cat({PotentialForce(pairs, config), torque * AngularSigns(pairs, config)}, -1);
}

InteractionImpl::InteractionImpl(const InteractionConfig& config) : config_(config) {
  network_ = register_module(
      "network", torch::nn::Sequential(Linear(10, config.hidden), torch::nn::ReLU(),
                                       Linear(config.hidden, config.hidden), torch::nn::ReLU(),
                                       Linear(config.hidden, 4)));
}

Tensor InteractionImpl::Learned(const PairTensors& pairs) {
  const auto& [own, other] = pairs;
  const Tensor place = Planar(own.position) - Planar(other.position);
  const Tensor rate = own.velocity - other.velocity;
  const Tensor leans = torch::stack({own.position.select(-1, 2), other.position.select(-1, 2),
                                     own.position.select(-1, 3), other.position.select(-1, 3)},
                                    -1);
  const Tensor inputs = torch::cat({place, rate.slice(-1, 0, 2), leans, rate.slice(-1, 2)}, -1);
  const Tensor answer =
      network_->forward((inputs - Row(kInputMean, inputs)) / Row(kInputDeviation, inputs));
  const Tensor force = answer * Row(kForceDeviation, inputs) + Row(kForceMean, inputs);
  return torch::minimum(torch::maximum(force, Row(kForceLeast, inputs)),
                        Row(kForceGreatest, inputs));
}

Tensor InteractionImpl::Forces(const PendulumTensors& states, const Tensor& there) {
  const auto people = states.rod.size(1);
  const Tensor places = Planar(states.position);
  const Tensor distance = Length(places.unsqueeze(2) - places.unsqueeze(1));
  const Tensor moving = Length(Planar(states.velocity)) > config_.moving_speed;
  const Tensor exists = there > 0;
  const Tensor self = torch::eye(people, torch::TensorOptions(torch::kBool));
  const Tensor neighbours = (distance < config_.reach_m) & moving.unsqueeze(1) &
                            exists.unsqueeze(1) & exists.unsqueeze(2) & ~self;
  const Tensor found = neighbours.nonzero();  // (pairs, 3): take, own, other
  const Tensor zero = torch::zeros({states.rod.numel(), 4}, states.rod.options());
  if (found.size(0) == 0) return zero.reshape_as(states.position);
  const Tensor first = found.select(1, 0) * people;
  const Tensor own = first + found.select(1, 1);
  const PairTensors pairs{PeopleAt(states, own), PeopleAt(states, first + found.select(1, 2))};
  Tensor forces = torch::zeros({found.size(0), 4}, states.rod.options());
  if (config_.basic) forces = forces + BasicForces(pairs, config_);
  if (config_.learned) forces = forces + Learned(pairs);
  return zero.index_add(0, own, forces).reshape_as(states.position);
}

}  // namespace poise::push::ldp
