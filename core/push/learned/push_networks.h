#ifndef POISE_CORE_PUSH_LEARNED_PUSH_NETWORKS_H_
#define POISE_CORE_PUSH_LEARNED_PUSH_NETWORKS_H_

#include <vector>

#include "core/artifacts/model_artifact.h"
#include "core/base/status.h"
#include "core/push/learned/hip_model.h"
#include "core/push/learned/pose_model.h"
#include "core/push/restoration/step_planner.h"

namespace poise::push {

/// The trained networks of a push model: two ensembles, of which the means are the forecast.
struct PushNetworks {
  std::vector<HipModel> hips;
  std::vector<PoseModel> poses;
  StepConfig steps;

  /// From a model of family "push": sizes from the card's config (PushTraining), numbers below
  /// "hip0.", "hip1.", ..., "pose0.", ... Errors: kFailedPrecondition WRONG_FAMILY;
  /// kInvalidArgument MISSING_TENSOR, WRONG_SHAPE; config errors.
  static StatusOr<PushNetworks> Read(const artifacts::ModelArtifact& model);

  /// Frames of the hip's path that the bodies need in advance.
  int lookahead() const { return poses.front().config().lookahead; }
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_LEARNED_PUSH_NETWORKS_H_
