#ifndef POISE_CORE_PUSH_LDP_BALANCE_H_
#define POISE_CORE_PUSH_LDP_BALANCE_H_

#include <torch/torch.h>

#include "core/push/ldp/ldp_config.h"
#include "core/push/ldp/pendulum_tensors.h"

namespace poise::push::ldp {

/// What people remember while they balance.
struct BalanceMemory {
  torch::Tensor hidden, cell;  ///< (people, self_hidden) of the LSTM
  torch::Tensor error;         ///< (people, 4) of the PD control, a frame before
};

/// What a person does against falling in one frame.
struct BalanceForces {
  torch::Tensor self;     ///< (people, 4) of the network
  torch::Tensor control;  ///< (people, 4) of network, PD and friction
};

/// PD control, the self network (an LSTM), friction with one learned coefficient, and the network
/// that changes the rod's length. Gradients flow through the simulated
/// states, and through the LSTM's memory where the config says so. Source: reference sec. 4.2, 4.3.
class BalanceImpl : public torch::nn::Module {
 public:
  explicit BalanceImpl(const BalanceConfig& config);

  BalanceMemory Begin(const PendulumTensors& states) const;
  /// `states` of (people); changes the memory.
  BalanceForces Forces(const PendulumTensors& states, const torch::Tensor& mass,
                       BalanceMemory& memory);
  /// (people) [m] in the next frame.
  torch::Tensor NextRod(const PendulumTensors& states, const torch::Tensor& mass,
                        const torch::Tensor& self);

 private:
  torch::Tensor MassInput(const torch::Tensor& mass) const;

  const BalanceConfig config_;
  torch::nn::Linear self_in_{nullptr}, self_out_{nullptr};
  torch::nn::LSTMCell self_cell_{nullptr};
  torch::nn::Sequential rod_{nullptr};
  torch::Tensor friction_;
};
TORCH_MODULE(Balance);

}  // namespace poise::push::ldp

#endif  // POISE_CORE_PUSH_LDP_BALANCE_H_
