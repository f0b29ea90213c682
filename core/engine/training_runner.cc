#include "core/engine/training_runner.h"

#include <utility>

#include "core/engine/flow_table.h"
#include "core/engine/job_files.h"

namespace poise::engine {

StatusOr<jobs::RunOutput> TrainingRunner::Run(const jobs::RunInput& input,
                                              const jobs::JobContext& context) {
  const base::Json& parameters = input.spec.parameters;
  POISE_ASSIGN_OR_RETURN(
      const std::string clips,
      ReadInput(input, parameters.value("data_artifact", ""), "spec.parameters.data_artifact"));
  base::RunContext run = context.run;
  run.seed = input.seed;
  POISE_ASSIGN_OR_RETURN(
      pipeline::TrainedModel trained,
      train_(parameters, clips, run, input.checkpoint,
             {context.checkpoint_interval, context.save_checkpoint, kCheckpointShare}));
  jobs::RunOutput output;
  output.report = {{"scores", trained.model.card.scores},
                   {"trained_on", trained.model.card.trained_on},
                   {"steps", trained.model.card.steps}};
  POISE_RETURN_IF_ERROR(WriteOutput(input, std::string(kModelFile), "application/octet-stream",
                                    artifacts::PackModel(std::move(trained.model)), output));
  for (const pipeline::TrainedModel::File& file : trained.files) {
    POISE_RETURN_IF_ERROR(WriteOutput(input, file.name, file.media_type, file.bytes, output));
  }
  return output;
}

}  // namespace poise::engine
