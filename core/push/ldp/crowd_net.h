#ifndef POISE_CORE_PUSH_LDP_CROWD_NET_H_
#define POISE_CORE_PUSH_LDP_CROWD_NET_H_

#include <torch/torch.h>

#include "core/push/ldp/balance.h"
#include "core/push/ldp/interaction.h"
#include "core/push/ldp/take_tensors.h"

namespace poise::push::ldp {

/// What pendulums do. Shapes: states (takes, people, frames)
struct CrowdPaths {
  PendulumTensors states;
  torch::Tensor active;  ///< (takes, people, frames) 1 from when something acts on a person
};

/// The differentiable pendulums of everybody in a scene, under pushes, balance and interaction.
/// Semi-implicit Euler at 60 Hz with the authors' limits on rates. Single people have other limits
/// than several, as the programs have. Source: reference sec. 4, 5.
class CrowdNetImpl : public torch::nn::Module {
 public:
  CrowdNetImpl(const BalanceConfig& balance, const InteractionConfig& interaction);

  /// `frames` from frame 0 on, of which only frame 0 and the push are looked at.
  CrowdPaths Rollout(const TakeTensors& takes, int64_t frames);

  Balance balance{nullptr};
  Interaction interaction{nullptr};

 private:
  const BalanceConfig config_;
};
TORCH_MODULE(CrowdNet);

/// The parts of the pendulums' loss, means over frames and people that exist (sec. 4.5, 5.6).
struct CrowdErrors {
  torch::Tensor states;    ///< mean absolute errors of places, leans and rates but phi's, summed
  torch::Tensor phi_rate;  ///< alone: its size; several people: its error
  torch::Tensor rod;       ///< [m]
  torch::Tensor hip;       ///< [m] distance of rod ends, of the length of frame 0, from hips
};
CrowdErrors ErrorsOf(const CrowdPaths& paths, const TakeTensors& takes);

}  // namespace poise::push::ldp

#endif  // POISE_CORE_PUSH_LDP_CROWD_NET_H_
