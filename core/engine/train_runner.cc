#include "core/engine/train_runner.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <utility>

#include "core/engine/flow_table.h"

namespace poise::engine {
namespace {

/// Checkpoints may take this part of the time; more than that, and they wait for the interval.
constexpr double kCheckpointShare = 0.05;

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

StatusOr<jobs::RunOutput> TrainRunner::Run(const jobs::RunInput& input,
                                           const jobs::JobContext& context) {
  POISE_ASSIGN_OR_RETURN(const pipeline::TrainSpec spec,
                         pipeline::TrainSpec::FromParameters(input.spec.parameters, kind_));
  POISE_ASSIGN_OR_RETURN(const std::string clips, ReadInput(input, spec.data_artifact));
  base::RunContext run = context.run;
  run.seed = input.seed;
  POISE_ASSIGN_OR_RETURN(
      pipeline::TrainedModel trained,
      train_(spec, clips, run, input.checkpoint,
             {context.checkpoint_interval, context.save_checkpoint, kCheckpointShare}));
  jobs::RunOutput output;
  output.report = {{"scores", trained.model.card.scores},
                   {"trained_on", trained.model.card.trained_on},
                   {"steps", trained.model.card.steps}};
  POISE_RETURN_IF_ERROR(Write(input.folder, std::string(kModelFile), "application/octet-stream",
                              artifacts::PackModel(std::move(trained.model)), output));
  for (const pipeline::TrainedModel::File& file : trained.files) {
    POISE_RETURN_IF_ERROR(Write(input.folder, file.name, file.media_type, file.bytes, output));
  }
  return output;
}

}  // namespace poise::engine
