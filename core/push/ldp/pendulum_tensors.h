#ifndef POISE_CORE_PUSH_LDP_PENDULUM_TENSORS_H_
#define POISE_CORE_PUSH_LDP_PENDULUM_TENSORS_H_

#include <torch/torch.h>

/// The equations of core/push/pendulum on tensors, so that gradients flow through them. A test
/// holds both against each other.
/// Shapes: any, the same for all: (...) for numbers of a person, (..., 4) for coordinates
namespace poise::push::ldp {

struct PendulumTensors {
  torch::Tensor position;  ///< (..., 4): x, y [m], theta, phi [rad]
  torch::Tensor velocity;  ///< (..., 4)
  torch::Tensor rod;       ///< (...) [m]
};

/// (..., 4) under `force` (..., 4). Preconditions: |theta| below pi/2, mass and rod positive.
torch::Tensor Accelerations(const PendulumTensors& states, const torch::Tensor& mass,
                            const torch::Tensor& force);

/// Where the rods end: (..., 3).
torch::Tensor RodEnds(const torch::Tensor& position, const torch::Tensor& rod,
                      const torch::Tensor& cart_height);

/// Generalised forces (..., 4) of horizontal ones (..., 2) at the rods' ends.
torch::Tensor AtRodEnd(const PendulumTensors& states, const torch::Tensor& force);

}  // namespace poise::push::ldp

#endif  // POISE_CORE_PUSH_LDP_PENDULUM_TENSORS_H_
