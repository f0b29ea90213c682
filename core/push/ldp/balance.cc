#include "core/push/ldp/balance.h"

#include <tuple>

namespace poise::push::ldp {
namespace {

using torch::Tensor;
using torch::nn::Linear;

constexpr int kCoordinates = 4;
constexpr int kSelfInputs = 7;                              // lean, all rates, mass
constexpr int kRodInputs = kSelfInputs + kCoordinates + 1;  // and self force, rod

// (people, 6): lean and all rates.
Tensor StateInputs(const PendulumTensors& states) {
  return torch::cat({states.position.slice(-1, 2), states.velocity}, -1);
}

Tensor PdError(const PendulumTensors& states) {
  return -torch::cat({states.velocity.slice(-1, 0, 2), states.position.slice(-1, 2)}, -1);
}

}  // namespace

BalanceImpl::BalanceImpl(const BalanceConfig& config) : config_(config) {
  self_in_ = register_module("self_in", Linear(kSelfInputs, config.self_input));
  self_cell_ =
      register_module("self_cell", torch::nn::LSTMCell(config.self_input, config.self_hidden));
  self_out_ = register_module("self_out", Linear(config.self_hidden, kCoordinates));
  rod_ = register_module(
      "rod", torch::nn::Sequential(Linear(kRodInputs, config.rod_hidden), torch::nn::ReLU(),
                                   Linear(config.rod_hidden, config.rod_hidden), torch::nn::ReLU(),
                                   Linear(config.rod_hidden, 1)));
  friction_ = register_parameter("friction", torch::full({1}, config.friction));
}

Tensor BalanceImpl::MassInput(const Tensor& mass) const {
  return mass.unsqueeze(-1) / config_.input_unit;
}

BalanceMemory BalanceImpl::Begin(const PendulumTensors& states) const {
  const Tensor zero = torch::zeros({states.rod.size(0), config_.self_hidden}, states.rod.options());
  return {zero, zero, PdError(states)};
}

BalanceForces BalanceImpl::Forces(const PendulumTensors& states, const Tensor& mass,
                                  BalanceMemory& memory) {
  std::tie(memory.hidden, memory.cell) = self_cell_(
      torch::relu(self_in_(torch::cat({StateInputs(states), MassInput(mass)}, -1))),
      config_.memory_gradient ? std::make_tuple(memory.hidden, memory.cell)
                              : std::make_tuple(memory.hidden.detach(), memory.cell.detach()));
  const Tensor self = config_.self_scale * self_out_(memory.hidden);
  const Tensor error = PdError(states);
  const Tensor gain =
      torch::tensor({config_.speed_gain, config_.speed_gain, config_.lean_gain, config_.lean_gain},
                    error.options());
  const Tensor rate =
      torch::tensor({config_.speed_rate, config_.speed_rate, config_.lean_rate, config_.lean_rate},
                    error.options());
  const Tensor pd = gain * error + rate * (error - memory.error);
  memory.error = error;
  const Tensor brake = -friction_ * states.velocity.slice(-1, 0, 2);
  return {self, self + pd + torch::cat({brake, torch::zeros_like(brake)}, -1)};
}

Tensor BalanceImpl::NextRod(const PendulumTensors& states, const Tensor& mass, const Tensor& self) {
  const Tensor inputs = torch::cat(
      {StateInputs(states), self / config_.input_unit, MassInput(mass), states.rod.unsqueeze(-1)},
      -1);
  const Tensor change = config_.rod_change * torch::tanh(0.5 * rod_->forward(inputs).squeeze(-1));
  return (states.rod + change).clamp(config_.rod_shortest, config_.rod_longest);
}

}  // namespace poise::push::ldp
