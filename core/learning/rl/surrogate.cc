#include "core/learning/rl/surrogate.h"

#include <ATen/ATen.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace poise::rl {

Surrogate EvaluateSurrogate(const at::Tensor& means, const at::Tensor& log_deviations,
                            const SurrogateInput& input, const PpoConfig& config) {
  const auto num_actions = static_cast<double>(means.size(1));
  const double log_deviation_sum = log_deviations.sum().item<double>();
  const double constant = 0.5 * num_actions * std::log(2 * std::numbers::pi);
  const at::Tensor inverse = log_deviations.neg().exp();

  // ln p(a) of the normal distribution, then the ratio to the old policy's.
  const at::Tensor scores = (input.actions - means).mul_(inverse);  // (batch, actions)
  const at::Tensor squares = scores.square();
  const at::Tensor log_ratios = squares.sum(1)
                                    .mul_(-0.5)
                                    .sub_(input.log_probs)
                                    .sub_(log_deviation_sum + constant);  // (batch)
  const at::Tensor ratios = log_ratios.exp();                             // (batch)
  const at::Tensor weights =                                              // (batch) sum to 1
      input.weights / std::max(input.weights.sum().item<double>(), 1.0);

  Surrogate result;
  const at::Tensor free = ratios * input.advantages;
  const at::Tensor bounded = ratios.clamp(1 - config.clip, 1 + config.clip).mul_(input.advantages);
  const double objective = at::min(free, bounded).mul_(weights).sum().item<double>();
  const double entropy = log_deviation_sum + constant + 0.5 * num_actions;
  result.loss = -objective - config.entropy_weight * entropy;
  result.kl = (ratios - 1).sub_(log_ratios).mul_(weights).sum().item<double>();
  result.clip_fraction = (ratios - 1)
                             .abs_()
                             .gt(config.clip)
                             .to(weights.scalar_type())
                             .mul_(weights)
                             .sum()
                             .item<double>();

  // d loss / d ln p: where the bounded branch is the smaller one, the ratio is constant.
  const at::Tensor active = free.le(bounded).to(weights.scalar_type());
  const at::Tensor slopes = free.mul(weights).mul_(active).neg_().unsqueeze_(1);  // (batch, 1)
  result.means_gradient = scores.mul(inverse).mul_(slopes);
  result.log_deviations_gradient = (squares - 1).mul_(slopes).sum(0).sub_(config.entropy_weight);
  if (config.action_bound > 0) {
    const at::Tensor excess =
        means - means.clamp(-config.action_bound, config.action_bound);  // (batch, actions)
    const at::Tensor shares = weights.unsqueeze(1) * config.action_bound_weight;
    result.loss += 0.5 * (excess.square() * shares).sum().item<double>();
    result.means_gradient.add_(excess * shares);
  }
  return result;
}

}  // namespace poise::rl
