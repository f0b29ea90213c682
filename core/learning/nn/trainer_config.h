#ifndef POISE_CORE_LEARNING_NN_TRAINER_CONFIG_H_
#define POISE_CORE_LEARNING_NN_TRAINER_CONFIG_H_

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/config_fields.h"
#include "core/base/status.h"

namespace poise::learning {

/// How one network's weights follow their gradient, and how the step size changes.
struct OptimizerConfig {
  std::string type = "adam";          ///< sgd | adam | adamw
  double learning_rate = 1e-3;        ///< [> 0]
  double momentum = 0;                ///< [0 to 1) of sgd
  double beta1 = 0.9;                 ///< [0 to 1) of adam and adamw
  double beta2 = 0.999;               ///< [0 to 1)
  double epsilon = 1e-8;              ///< [> 0]
  double weight_decay = 0;            ///< [>= 0] L2; of adamw decoupled from the gradient
  int64_t warmup_steps = 0;           ///< [steps] over which the rate grows linearly from 0
  std::string schedule = "constant";  ///< constant | step | cosine (to 0 at the last step)
  int64_t decay_every = 1000;         ///< [steps] of schedule step
  double decay_factor = 0.5;          ///< [0 to 1] times the rate, each time
  double clip_norm = 0;               ///< [>= 0] greatest norm of the whole gradient; 0 = any

  std::vector<base::Field> Fields();
  Status Validate() const;
  /// Rate at `step` (from 0) of `steps`.
  double RateAt(int64_t step, int64_t steps) const;
};

/// How long and on what a trainer trains. Network-specific numbers stand beside the network.
struct TrainerConfig {
  int64_t steps = 10'000;         ///< [> 0] optimiser steps of every network
  int batch_size = 32;            ///< [> 0] samples of one step
  bool with_replacement = false;  ///< draw each sample anew | every sample once an epoch, shuffled
  int64_t validate_every = 500;   ///< [steps]
  /// [validations] in a row without a better score that end the training; 0 = never.
  int patience = 0;
  int64_t curve_every = 100;  ///< [steps] averaged into one row of the learning curve
  double max_seconds = 0;     ///< [s] of this run after which it ends as it is; 0 = no limit
  int threads = 1;            ///< [> 0] of LibTorch; only 1 is reproducible bit for bit

  std::vector<base::Field> Fields();
  Status Validate() const;
};

}  // namespace poise::learning

#endif  // POISE_CORE_LEARNING_NN_TRAINER_CONFIG_H_
