#include "core/engine/job_files.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

namespace poise::engine {

StatusOr<std::string> ReadInput(const jobs::RunInput& input, const std::string& artifact,
                                std::string_view field) {
  const auto path = input.inputs.find(artifact);
  if (path == input.inputs.end()) {
    return base::NotFound("INPUT_NOT_FOUND", field,
                          fmt::format("'{}' is not among the inputs", artifact));
  }
  std::ifstream stream(path->second, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(stream), {});
  if (stream.good() || stream.eof()) return bytes;
  return base::NotFound("INPUT_NOT_FOUND", field,
                        fmt::format("cannot read {}", path->second.string()));
}

StatusOr<artifacts::ModelArtifact> ReadModel(const jobs::RunInput& input,
                                             const std::string& artifact, const std::string& name,
                                             std::string_view field) {
  POISE_ASSIGN_OR_RETURN(const std::string bytes, ReadInput(input, artifact, field));
  StatusOr<artifacts::ModelArtifact> model = artifacts::UnpackModel(bytes, name);
  if (!model.ok()) return base::Annotate(model.status(), "model", field);
  return model;
}

Status WriteOutput(const jobs::RunInput& input, const std::string& name,
                   const std::string& media_type, std::string_view bytes, jobs::RunOutput& output) {
  const std::filesystem::path path = input.folder / name;
  std::ofstream stream(path, std::ios::binary);
  stream << bytes;
  stream.close();
  if (!stream.good()) {
    return base::ResourceExhausted("CANNOT_WRITE", "",
                                   fmt::format("cannot write {}", path.string()));
  }
  output.files.push_back({.name = name, .path = path, .media_type = media_type});
  return absl::OkStatus();
}

}  // namespace poise::engine
