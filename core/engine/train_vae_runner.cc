#include "core/engine/train_vae_runner.h"

#include <utility>

#include "core/engine/flow_table.h"
#include "core/engine/runner_files.h"
#include "core/pipeline/train_vae.h"

namespace poise::engine {

StatusOr<jobs::RunOutput> TrainVaeRunner::Run(const jobs::RunInput& input,
                                              const jobs::JobContext& context) {
  POISE_ASSIGN_OR_RETURN(const pipeline::TrainVaeSpec spec,
                         pipeline::TrainVaeSpec::FromParameters(input.spec.parameters));
  POISE_ASSIGN_OR_RETURN(const std::string clips,
                         ReadInput(input, spec.data_artifact, "data_artifact"));
  base::RunContext run = context.run;
  run.seed = input.seed;
  POISE_ASSIGN_OR_RETURN(
      synthesis::VaeResult result,
      pipeline::TrainVae(spec, clips, run, input.checkpoint,
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
  POISE_RETURN_IF_ERROR(
      WriteOutput(input.folder, "learning_curve.svg", "image/svg+xml", result.curve_svg, output));
  if (!result.latent_map_svg.empty()) {
    POISE_RETURN_IF_ERROR(WriteOutput(input.folder, "latent_map.svg", "image/svg+xml",
                                      result.latent_map_svg, output));
  }
  return output;
}

}  // namespace poise::engine
