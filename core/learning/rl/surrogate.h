#ifndef POISE_CORE_LEARNING_RL_SURROGATE_H_
#define POISE_CORE_LEARNING_RL_SURROGATE_H_

#include <ATen/core/Tensor.h>

#include "core/learning/rl/ppo_config.h"

namespace poise::rl {

/// A minibatch as the policy's loss sees it.
struct SurrogateInput {
  at::Tensor actions;     // (batch, actions) that were taken
  at::Tensor log_probs;   // (batch) of them under the policy that took them
  at::Tensor advantages;  // (batch)
  at::Tensor weights;     // (batch) 1 for steps that count, else 0
};

/// The loss of the policy on a minibatch and its gradient.
struct Surrogate {
  double loss = 0;
  double kl = 0;  ///< [nats] estimate of the divergence from the old policy (Schulman's k3)
  double clip_fraction = 0;            ///< share of ratios outside 1 +- clip
  at::Tensor means_gradient;           // (batch, actions) of the loss
  at::Tensor log_deviations_gradient;  // (actions) of the loss
};

/// Clipped surrogate objective (Schulman et al. 2017, eq. 7) of a normal policy, as a loss, minus
/// the weighted entropy, plus the punishment of means out of bounds. Averages run over the steps
/// that count.
/// Shapes: means (batch, actions), log_deviations (actions) of the policy that learns.
Surrogate EvaluateSurrogate(const at::Tensor& means, const at::Tensor& log_deviations,
                            const SurrogateInput& input, const PpoConfig& config);

}  // namespace poise::rl

#endif  // POISE_CORE_LEARNING_RL_SURROGATE_H_
