#include "core/engine/learning_runners.h"

#include "core/engine/correct_runner.h"
#include "core/engine/evaluate_push_runner.h"
#include "core/engine/flow_table.h"
#include "core/engine/training_runner.h"
#include "core/pipeline/load_decoder.h"
#include "core/pipeline/make_policy_learner.h"
#include "core/pipeline/paper_forecaster.h"
#include "core/pipeline/train_debias.h"
#include "core/pipeline/train_predictor.h"
#include "core/pipeline/train_push.h"
#include "core/pipeline/train_vae.h"

namespace poise::engine {

StatusOr<std::unique_ptr<jobs::JobRunner>> MakeRunner(std::string_view kind) {
  POISE_ASSIGN_OR_RETURN(const Flow* flow, FindFlow(kind));
  if (kind == "correct")
    return std::make_unique<CorrectRunner>(pipeline::MakePolicyLearner, pipeline::LoadDecoder);
  if (kind == "evaluate_push") return MakeEvaluatePushRunner(pipeline::MakePaperForecaster());
  if (flow->make_runner != nullptr) return flow->make_runner();
  if (kind == "train_predictor") return std::make_unique<TrainingRunner>(pipeline::TrainPredictor);
  if (kind == "train_push") return std::make_unique<TrainingRunner>(pipeline::TrainPush);
  if (kind == "train_debias") return std::make_unique<TrainingRunner>(pipeline::TrainDebias);
  return std::make_unique<TrainingRunner>(pipeline::TrainVae);
}

}  // namespace poise::engine
