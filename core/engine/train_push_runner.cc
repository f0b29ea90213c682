#include "core/engine/train_push_runner.h"

#include <utility>

#include "core/engine/flow_table.h"
#include "core/engine/runner_files.h"
#include "core/pipeline/train_push.h"

namespace poise::engine {

StatusOr<jobs::RunOutput> TrainPushRunner::Run(const jobs::RunInput& input,
                                               const jobs::JobContext& context) {
  POISE_ASSIGN_OR_RETURN(const pipeline::TrainPushSpec spec,
                         pipeline::TrainPushSpec::FromParameters(input.spec.parameters));
  POISE_ASSIGN_OR_RETURN(const std::string takes,
                         ReadInput(input, spec.data_artifact, "data_artifact"));
  base::RunContext run = context.run;
  run.seed = input.seed;
  POISE_ASSIGN_OR_RETURN(
      push::PushResult result,
      pipeline::TrainPush(spec, takes, run, input.checkpoint,
                          {context.checkpoint_interval, context.save_checkpoint}));
  jobs::RunOutput output;
  output.report = {{"scores", result.model.card.scores},
                   {"trained_on", result.model.card.trained_on},
                   {"steps", result.model.card.steps}};
  POISE_RETURN_IF_ERROR(WriteOutput(input.folder, std::string(kModelFile),
                                    "application/octet-stream",
                                    artifacts::PackModel(std::move(result.model)), output));
  POISE_RETURN_IF_ERROR(
      WriteOutput(input.folder, "learning_curve.csv", "text/csv", result.curve_csv, output));
  return output;
}

}  // namespace poise::engine
