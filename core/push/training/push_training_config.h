#ifndef POISE_CORE_PUSH_TRAINING_PUSH_TRAINING_CONFIG_H_
#define POISE_CORE_PUSH_TRAINING_PUSH_TRAINING_CONFIG_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/base/config_fields.h"
#include "core/base/status.h"
#include "core/push/learned/hip_config.h"
#include "core/push/learned/pose_config.h"
#include "core/push/restoration/step_planner.h"

namespace poise::push {

/// What both networks have in common when they learn: AdamW, a rate that falls along a cosine.
struct NetworkTraining {
  int64_t steps = 1000;         ///< [> 0] of the optimiser
  int batch_size = 8;           ///< [> 0]
  double learning_rate = 4e-3;  ///< [> 0] at first
  double weight_decay = 1e-3;   ///< [0 to 1]
  double clip_norm = 1;         ///< [> 0] of the gradient
  int64_t validate_every = 30;  ///< [steps]

  std::vector<base::Field> Fields();
};

/// How the hip network learns: whole roll-outs from frame 0.
struct HipTraining {
  NetworkTraining network = {.steps = 400, .batch_size = 16};  ///< samples are takes
  int first_frames = 30;          ///< [> 1] length of roll-outs at first
  double growing_share = 0.4;     ///< [0 to 1] of the steps in which they grow to all frames
  double velocity_weight = 0.05;  ///< [0 to 10] of hip speed errors beside place errors
  double lean_weight = 0.2;       ///< [0 to 10] of lean errors
  double still_share = 0.1;       ///< [0 to 1] of takes shown without push, where nobody moves
  bool mirror = true;             ///< half of the takes change left and right

  std::vector<base::Field> Fields();
};

/// How the pose network learns: on recorded hips, bent a little, and on forecast ones.
struct PoseTraining {
  NetworkTraining network = {  ///< samples are people
      .steps = 1200,
      .batch_size = 32,
      .learning_rate = 3e-3,
      .validate_every = 60};
  double hip_distortion = 0.15;  ///< [0 to 1] deviation of a factor on the hip's path
  /// [0 to 1] share of samples on hips as networks forecast them that did not learn from the take.
  /// What is uncertain about the hip makes the body cautious.
  double forecast_share = 0.5;
  double single_share = 0.35;  ///< [0 to 1] of samples from takes of one person alone
  double speed_weight = 0.02;  ///< [0 to 10] of errors in joint speed beside places
  double foot_weight = 0.3;    ///< [0 to 10] of errors in footholds
  double swing_weight = 0.03;  ///< [0 to 10] of the cross-entropy of which foot swings
  bool mirror = true;          ///< half of the people change left and right

  std::vector<base::Field> Fields();
};

/// Everything that makes a push model: an ensemble of each network, whose means are the forecast.
struct PushTraining {
  std::string protocol = "B";  ///< A, B or C: what the networks know of a push
  int hip_members = 6;         ///< [1 to 64] each has other validation takes
  int pose_members = 1;        ///< [1 to 64] likewise
  /// No member sees the validation takes of fold 0, so that they judge settings.
  bool hold_out = false;
  int every_take = 1;  ///< [1 to 100] learn from every so many training takes only
  HipConfig hip;
  PoseConfig pose;
  HipTraining hip_training;
  PoseTraining pose_training;
  StepConfig steps;

  /// "recommended". Errors: kInvalidArgument UNKNOWN_PRESET.
  static StatusOr<PushTraining> FromPreset(std::string_view name);
  std::vector<base::Field> Fields();
  Status Validate();
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TRAINING_PUSH_TRAINING_CONFIG_H_
