#ifndef POISE_CORE_PUSH_LDP_INTERACTION_H_
#define POISE_CORE_PUSH_LDP_INTERACTION_H_

#include <torch/torch.h>

#include "core/push/ldp/ldp_config.h"
#include "core/push/ldp/pendulum_tensors.h"

namespace poise::push::ldp {

/// Pairs of people: what the first of them feels of the second. All in one table of pairs.
struct PairTensors {
  PendulumTensors own, other;  ///< (pairs)
};

/// The forces of a potential between carts: (pairs, 2) [N] on `own`, without weight.
torch::Tensor PotentialForce(const PairTensors& pairs, const InteractionConfig& config);
/// The angular table: (pairs, 2) in -1, 0, 1 for theta and phi of `own`, without weight.
torch::Tensor AngularSigns(const PairTensors& pairs, const InteractionConfig& config);
/// (pairs, 4) generalised, weighted by relative speed and distance: what needs no learning.
torch::Tensor BasicForces(const PairTensors& pairs, const InteractionConfig& config);

/// The forces between people: a network and basic forces, summed over neighbours. Gradients reach
/// the network from every later state (a test shows it by finite differences); in the authors'
/// program they do not. Source: reference sec. 5.1 to 5.3.
class InteractionImpl : public torch::nn::Module {
 public:
  explicit InteractionImpl(const InteractionConfig& config);

  /// `states` of (takes, people); `there` (takes, people) is 1 for people that exist.
  /// Shape: (takes, people, 4)
  torch::Tensor Forces(const PendulumTensors& states, const torch::Tensor& there);

 private:
  torch::Tensor Learned(const PairTensors& pairs);

  const InteractionConfig config_;
  torch::nn::Sequential network_{nullptr};
};
TORCH_MODULE(Interaction);

}  // namespace poise::push::ldp

#endif  // POISE_CORE_PUSH_LDP_INTERACTION_H_
