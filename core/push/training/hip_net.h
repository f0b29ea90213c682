#ifndef POISE_CORE_PUSH_TRAINING_HIP_NET_H_
#define POISE_CORE_PUSH_TRAINING_HIP_NET_H_

#include <torch/torch.h>

#include "core/push/learned/hip_config.h"
#include "core/push/training/take_batch.h"

namespace poise::push {

/// Paths that a network makes from what it may know of a batch: frame 0, push and context.
struct HipPaths {
  torch::Tensor hip;   ///< (takes, people, frames, 2)
  torch::Tensor lean;  ///< (takes, people, frames, 2)
};

/// Moves everybody's pendulum: in each frame a recurrent cell per person, with shared weights,
/// gives the accelerations of hip and lean, on top of the push's own; neighbours send messages.
/// Gradients flow through states and memory over the whole roll-out. Source: own design; differs
/// from the paper's self and interaction networks (reference sec. 4, 5), which do not know the push
/// and act between feet.
class HipNetImpl : public torch::nn::Module {
 public:
  explicit HipNetImpl(const HipConfig& config);

  /// `frames` of the batch, frame 0 included.
  HipPaths Rollout(const TakeBatch& batch, int64_t frames);

 private:
  struct State;

  torch::Tensor Messages(const TakeBatch& batch, const State& state, const torch::Tensor& pairs);

  HipConfig config_;
  torch::nn::Linear message_in_{nullptr}, message_out_{nullptr};
  torch::nn::GRUCell cell_{nullptr};
  torch::nn::Linear drive_{nullptr};
};
TORCH_MODULE(HipNet);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TRAINING_HIP_NET_H_
