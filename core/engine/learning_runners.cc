#include "core/engine/learning_runners.h"

#include "core/engine/correct_runner.h"
#include "core/engine/flow_table.h"
#include "core/engine/train_runner.h"
#include "core/pipeline/load_decoder.h"
#include "core/pipeline/make_policy_learner.h"

namespace poise::engine {

StatusOr<std::unique_ptr<jobs::JobRunner>> MakeRunner(std::string_view kind) {
  POISE_ASSIGN_OR_RETURN(const Flow* flow, FindFlow(kind));
  if (kind == "correct")
    return std::make_unique<CorrectRunner>(pipeline::MakePolicyLearner, pipeline::LoadDecoder);
  if (flow->make_runner != nullptr) return flow->make_runner();
  return std::make_unique<TrainRunner>(
      std::string(kind), kind == "train_debias" ? pipeline::TrainDebias : pipeline::TrainVae);
}

}  // namespace poise::engine
