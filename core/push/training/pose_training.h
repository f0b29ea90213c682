#ifndef POISE_CORE_PUSH_TRAINING_POSE_TRAINING_H_
#define POISE_CORE_PUSH_TRAINING_POSE_TRAINING_H_

#include <vector>

#include "core/base/config_fields.h"
#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/learning/nn/trainer.h"
#include "core/push/takes/fzj_takes.h"
#include "core/push/training/pose_net.h"

namespace poise::push {

/// How the pose network learns: on recorded hips, bent a little.
struct PoseTrainingConfig {
  int64_t steps = 1200;          ///< [> 0] of the optimiser
  int batch_size = 32;           ///< [people]
  double learning_rate = 3e-3;   ///< [> 0] at first; falls along a cosine
  double weight_decay = 1e-3;    ///< [0 to 1]
  double clip_norm = 1;          ///< [> 0] of the gradient
  double hip_distortion = 0.15;  ///< [0 to 1] deviation of a factor on the hip's path
  double speed_weight = 0.02;    ///< [0 to 10] of errors in joint speed beside places
  bool mirror = true;            ///< half of the people change left and right
  int64_t validate_every = 60;   ///< [steps]

  std::vector<base::Field> Fields();
};

/// One person of a take.
struct PersonRef {
  const PushTake* take = nullptr;
  int person = 0;
};
std::vector<PersonRef> PeopleOf(const std::vector<const PushTake*>& takes);

/// Recorded people; `lookahead` frames beyond the end repeat the last speed, slowed down, and are
/// not scored. `random` draws mirroring and distortion; none when it is null.
PoseBatch MakePoseBatch(const std::vector<PersonRef>& people, int lookahead,
                        const PoseTrainingConfig& config, base::Random* random);

struct TrainedPose {
  PoseNet net{nullptr};
  learning::TrainingReport report;
};
/// Errors: those of Trainer.
StatusOr<TrainedPose> TrainPose(const TrainingTakes& takes, const PoseConfig& net,
                                const PoseTrainingConfig& config, const base::RunContext& context);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TRAINING_POSE_TRAINING_H_
