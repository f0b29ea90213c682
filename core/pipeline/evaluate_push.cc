#include "core/pipeline/evaluate_push.h"

#include "core/artifacts/model_artifact.h"
#include "core/push/takes/fzj_takes.h"
#include "core/push/takes/take_file.h"

namespace poise::pipeline {

StatusOr<std::vector<push::ForecasterScores>> EvaluatePush(const EvaluatePushSpec& spec,
                                                           std::string_view take_file,
                                                           std::string_view packed_model,
                                                           const base::RunContext& context,
                                                           const push::PaperForecaster& paper) {
  POISE_ASSIGN_OR_RETURN(const std::vector<push::PushTake> takes,
                         push::DecodeTakes(take_file, spec.data_artifact));
  artifacts::ModelArtifact model;
  std::vector<push::NamedModel> models;
  if (!packed_model.empty()) {
    POISE_ASSIGN_OR_RETURN(model, artifacts::UnpackModel(packed_model, spec.model_artifact));
    models.push_back({spec.model.empty() ? "model" : spec.model, model});
  }
  return push::EvaluatePush(models, push::TakesOf(takes, push::Split::kTest), context, paper);
}

}  // namespace poise::pipeline
