#include "core/engine/runner_files.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <utility>

namespace poise::engine {

StatusOr<std::string> ReadInput(const jobs::RunInput& input, const std::string& artifact,
                                const std::string& parameter) {
  const auto path = input.inputs.find(artifact);
  if (path == input.inputs.end()) {
    return base::InvalidArgument("MISSING_DATA", "spec.parameters." + parameter,
                                 fmt::format("'{}' is no artifact of this server", artifact));
  }
  std::ifstream file(path->second, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  if (file.good()) return std::move(bytes).str();
  return base::MakeError(absl::StatusCode::kUnavailable, "CANNOT_READ", "",
                         fmt::format("cannot read the copy of {}", artifact));
}

Status WriteOutput(const std::filesystem::path& folder, const std::string& name,
                   const std::string& media_type, const std::string& bytes,
                   jobs::RunOutput& output) {
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

}  // namespace poise::engine
