#ifndef POISE_CORE_LEARNING_RL_PPO_CONFIG_H_
#define POISE_CORE_LEARNING_RL_PPO_CONFIG_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/config_fields.h"
#include "core/base/status.h"

namespace poise::rl {

/// One network and what trains it. The policy and the value function have one each.
struct NetworkConfig {
  std::string hidden_layers = "128-128";  ///< sizes, from the input on; empty = linear
  std::string activation = "tanh";        ///< tanh | relu
  /// [>= 0] last weights are uniform within +- this over sqrt(inputs); hidden ones are Xavier's.
  double output_scale = 0.01;
  std::string optimizer = "adam";  ///< adam (beta 0.9, 0.999) | sgd (with momentum)
  double learning_rate = 3e-4;     ///< [> 0]
  double momentum = 0.9;           ///< [0 to 1) of sgd
  double weight_decay = 0;         ///< [>= 0] times 1/2 |weights|^2 in the loss; biases are free

  /// Errors: kInvalidArgument MALFORMED_CONFIG_VALUE.
  StatusOr<std::vector<int>> HiddenSizes() const;

  std::vector<base::Field> Fields();
};

/// Proximal policy optimisation (Schulman et al. 2017) with generalised advantages (Schulman et al.
/// 2016). Defaults are the preset `recommended`.
struct PpoConfig {
  // What a batch is.
  int samples_per_update = 2048;  ///< [>= 1] over all environments, rounded up to whole steps
  int warmup_samples = 512;       ///< [>= 0] before the first batch: only measure the observations
  int environments_per_task = 4;  ///< [>= 1] stepped in turn by one thread, one policy evaluation
  int threads = 0;                ///< [>= 0] for the environments; 0 = one per CPU

  // What is learned from it.
  double discount = 0.95;          ///< [0 to 1) gamma
  double trace = 0.95;             ///< [0 to 1] lambda: 0 trusts the value function, 1 the returns
  double advantage_limit = 0;      ///< [>= 0, standard deviations] clips advantages; 0 = off
  int minibatch = 256;             ///< [>= 1 samples]
  int epochs = 5;                  ///< [>= 1] over the batch, shuffled each time
  double clip = 0.2;               ///< [> 0] of the probability ratio around 1
  double entropy_weight = 0;       ///< [>= 0] of the policy's entropy in the loss
  double action_bound = 0;         ///< [>= 0] means beyond it are punished by 1/2 excess^2; 0 = off
  double action_bound_weight = 1;  ///< [>= 0] of that
  double gradient_norm = 1;        ///< [>= 0] longer gradients of a network are cut; 0 = off
  double kl_limit = 0.05;  ///< [>= 0 nats] the policy's epochs end beyond this divergence; 0 = off
  NetworkConfig actor;
  NetworkConfig critic;

  // Exploration.
  double noise = 0.05;         ///< [> 0] standard deviation of each action, in its own unit
  double noise_end = 0.05;     ///< [> 0] where a fixed noise arrives after noise_samples
  int64_t noise_samples = 0;   ///< [>= 0] 0 = the noise stays; else it falls exponentially
  bool learn_noise = false;    ///< one standard deviation per action, learned from `noise` on
  double exploration = 1;      ///< [0 to 1] share of steps with noise; only they train the actor
  double exploration_end = 1;  ///< [0 to 1] after exploration_samples, linearly
  int64_t exploration_samples = 0;  ///< [>= 0] 0 = the share stays

  // Schedule and scales.
  double learning_rate_end = 1;       ///< [> 0] factor on the learning rates at the end
  int64_t learning_rate_samples = 0;  ///< [>= 0] 0 = they stay; else the factor falls linearly
  bool normalize_returns = true;      ///< the critic learns returns of mean 0 and deviation 1
  double value_low = 0;  ///< without normalize_returns: the critic learns (return - middle) / half
  double value_high = 20;                   ///< of this range, to which returns are clipped
  int64_t observation_samples = 1'000'000;  ///< [>= 1] after them the normaliser stays as it is
  double observation_deviation_min = 0.02;  ///< [> 0] floor of an observation's deviation
  double observation_limit =
      10;  ///< [>= 0 deviations] normalised observations are clipped; 0 = off

  /// `paper`: the authors' program (MotionAug spec. sec. 4.11), but for its replay and its number
  /// of processes. Errors: kInvalidArgument UNKNOWN_PRESET.
  static StatusOr<PpoConfig> FromPreset(std::string_view preset);

  /// Names are as the members; those of the networks nested: "actor.learning_rate".
  std::vector<base::Field> Fields();

  /// Errors: kInvalidArgument, with the field: CONFIG_VALUE_OUT_OF_RANGE, MALFORMED_CONFIG_VALUE.
  Status Validate() const;
};

}  // namespace poise::rl

#endif  // POISE_CORE_LEARNING_RL_PPO_CONFIG_H_
