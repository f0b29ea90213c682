#include "core/engine/train_vae_runner.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <utility>

#include "core/engine/flow_table.h"
#include "core/pipeline/train_vae.h"

namespace poise::engine {
namespace {

StatusOr<std::string> ReadInput(const jobs::RunInput& input, const std::string& artifact) {
  const auto path = input.inputs.find(artifact);
  if (path == input.inputs.end()) {
    return base::InvalidArgument("MISSING_DATA", "spec.parameters.data_artifact",
                                 fmt::format("'{}' is no artifact of this server", artifact));
  }
  std::ifstream file(path->second, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  if (file.good()) return std::move(bytes).str();
  return base::MakeError(absl::StatusCode::kUnavailable, "CANNOT_READ", "",
                         fmt::format("cannot read the copy of {}", artifact));
}

Status Write(const std::filesystem::path& folder, const std::string& name,
             const std::string& media_type, const std::string& bytes, jobs::RunOutput& output) {
  const std::filesystem::path path = folder / name;
  std::ofstream file(path, std::ios::binary);
  file << bytes;
  file.close();
  if (!file.good()) {
    return base::ResourceExhausted("CANNOT_WRITE", "",
                                   fmt::format("cannot write {}", path.string()));
  }
  output.files.push_back({.name = name, .path = path, .media_type = media_type});
  return absl::OkStatus();
}

}  // namespace

StatusOr<jobs::RunOutput> TrainVaeRunner::Run(const jobs::RunInput& input,
                                              const jobs::JobContext& context) {
  POISE_ASSIGN_OR_RETURN(const pipeline::TrainVaeSpec spec,
                         pipeline::TrainVaeSpec::FromParameters(input.spec.parameters));
  POISE_ASSIGN_OR_RETURN(const std::string clips, ReadInput(input, spec.data_artifact));
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
  POISE_RETURN_IF_ERROR(Write(input.folder, std::string(kModelFile), "application/octet-stream",
                              artifacts::PackModel(std::move(result.model)), output));
  POISE_RETURN_IF_ERROR(
      Write(input.folder, "learning_curve.csv", "text/csv", result.curve_csv, output));
  POISE_RETURN_IF_ERROR(
      Write(input.folder, "learning_curve.svg", "image/svg+xml", result.curve_svg, output));
  if (!result.latent_map_svg.empty()) {
    POISE_RETURN_IF_ERROR(
        Write(input.folder, "latent_map.svg", "image/svg+xml", result.latent_map_svg, output));
  }
  return output;
}

}  // namespace poise::engine
