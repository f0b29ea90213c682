#ifndef POISE_CORE_PUSH_TRAINING_POSE_TRAINING_H_
#define POISE_CORE_PUSH_TRAINING_POSE_TRAINING_H_

#include <vector>

#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/push/takes/fzj_takes.h"
#include "core/push/training/pose_net.h"
#include "core/push/training/train_network.h"

namespace poise::push {

/// One person of a take.
struct PersonRef {
  const PushTake* take = nullptr;
  int person = 0;
};
std::vector<PersonRef> PeopleOf(const std::vector<const PushTake*>& takes);

/// Recorded people; `lookahead` frames beyond the end repeat the last speed, slowed down, and are
/// not scored. `random` draws mirroring and distortion; none when it is null.
PoseBatch MakePoseBatch(const std::vector<PersonRef>& people, int lookahead,
                        const PoseTraining& config, base::Random* random);

struct TrainedPose {
  PoseNet net{nullptr};
  learning::TrainingReport report;
  std::string curve_csv;
};
/// Errors: those of Trainer.
StatusOr<TrainedPose> TrainPose(const TrainingTakes& takes, const PoseConfig& net,
                                const PoseTraining& config, const base::RunContext& context,
                                const Resumption& resumption = {});

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TRAINING_POSE_TRAINING_H_
