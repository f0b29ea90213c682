#include "core/push/learned/push_networks.h"

#include <fmt/format.h>

#include "core/push/push_forecaster.h"
#include "core/push/training/push_training_config.h"

namespace poise::push {

StatusOr<PushNetworks> PushNetworks::Read(const artifacts::ModelArtifact& model) {
  if (model.card.family != kModelFamily) {
    return base::FailedPrecondition(
        "WRONG_FAMILY", "model",
        fmt::format("a model of family '{}' forecasts no pushes, those of family '{}' do",
                    model.card.family, kModelFamily));
  }
  PushTraining config;
  POISE_RETURN_IF_ERROR(base::FieldsFromJson(model.card.config, config.Fields()));
  POISE_RETURN_IF_ERROR(config.Validate());
  PushNetworks networks;
  networks.steps = config.steps;
  for (int i = 0; i < config.hip_members; ++i) {
    POISE_ASSIGN_OR_RETURN(HipModel hip,
                           HipModel::Read(model.weights, fmt::format("hip{}.", i), config.hip));
    networks.hips.push_back(std::move(hip));
  }
  for (int i = 0; i < config.pose_members; ++i) {
    POISE_ASSIGN_OR_RETURN(PoseModel pose,
                           PoseModel::Read(model.weights, fmt::format("pose{}.", i), config.pose));
    networks.poses.push_back(std::move(pose));
  }
  return networks;
}

}  // namespace poise::push
