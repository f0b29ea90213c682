#ifndef POISE_CORE_PUSH_TRAINING_POSE_TRAINING_H_
#define POISE_CORE_PUSH_TRAINING_POSE_TRAINING_H_

#include <vector>

#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/push/takes/fzj_takes.h"
#include "core/push/training/hip_training.h"
#include "core/push/training/pose_net.h"
#include "core/push/training/train_network.h"

namespace poise::push {

/// One person of a take.
struct PersonRef {
  const PushTake* take = nullptr;
  int person = 0;
};
std::vector<PersonRef> PeopleOf(const std::vector<const PushTake*>& takes);

/// Recorded bodies on recorded hips, of which the `lookahead` frames beyond the end repeat the last
/// speed, slowed down, or on hips from `forecasts`. `random` draws mirroring, distortion and whose
/// hip is forecast; when it is null there is no distortion and all hips are forecast that can be.
PoseBatch MakePoseBatch(const std::vector<PersonRef>& people, int lookahead,
                        const PoseTraining& config, const HipForecasts& forecasts,
                        base::Random* random);

struct TrainedPose {
  PoseNet net{nullptr};
  learning::TrainingReport report;
  std::string curve_csv;
};
/// `forecasts` are by networks that did not learn from the take; where there is none the recorded
/// hip is used. best_validation is the mean distance of joints from the pelvis, in metres, on
/// validation takes, mean of those with one person and those with several.
/// Errors: those of Trainer.
StatusOr<TrainedPose> TrainPose(const TrainingTakes& takes, const HipForecasts& forecasts,
                                const PoseConfig& net, const PoseTraining& config,
                                const base::RunContext& context, const Resumption& resumption = {});

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TRAINING_POSE_TRAINING_H_
