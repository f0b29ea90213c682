#include "core/runtime/jobs/manifest_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "core/base/json.h"
#include "core/base/sha256.h"
#include "core/base/version.h"
#include "core/runtime/jobs/job_json.h"

namespace poise::jobs {
namespace {

Status BadOutput(const OutputFile& file, std::string_view what) {
  return base::Internal("BAD_OUTPUT", fmt::format("file '{}' of the result {}", file.name, what));
}

bool StaysInside(const std::filesystem::path& name) {
  return !name.empty() && name.is_relative() && name == name.lexically_normal() &&
         name.has_filename() && *name.begin() != "..";
}

// Of kind, parameters and seed; the order in which parameters were written does not matter.
std::string InputHash(const RunInput& input) {
  const nlohmann::json sorted = {
      {"kind", input.spec.kind},
      {"parameters", nlohmann::json::parse(ToJson(input.spec.parameters))},
      {"seed", input.seed}};
  return base::Sha256Hex(sorted.dump());
}

StatusOr<base::Json> Describe(const OutputFile& file) {
  constexpr size_t kBlockBytes = size_t{1} << 20;
  std::ifstream stream(file.path, std::ios::binary);
  base::Sha256 hash;
  int64_t size = 0;
  std::vector<char> block(kBlockBytes);
  while (stream.read(block.data(), kBlockBytes) || stream.gcount() > 0) {
    hash.Update({block.data(), static_cast<size_t>(stream.gcount())});
    size += stream.gcount();
  }
  if (!stream.eof()) return BadOutput(file, "cannot be read");
  return base::Json{{"name", file.name},
                    {"size_bytes", size},
                    {"sha256", hash.HexDigest()},
                    {"media_type", file.media_type}};
}

}  // namespace

StatusOr<RunOutput> ManifestRunner::Run(const RunInput& input, const JobContext& context) {
  POISE_ASSIGN_OR_RETURN(RunOutput output, inner_->Run(input, context));
  std::sort(output.files.begin(), output.files.end(),
            [](const OutputFile& a, const OutputFile& b) { return a.name < b.name; });
  base::Json files = base::Json::array();
  std::string_view previous;
  for (const OutputFile& file : output.files) {
    if (!StaysInside(file.name)) return BadOutput(file, "has a name that is no path inside it");
    if (file.name == kManifestName) return BadOutput(file, "has the manifest's name");
    if (file.name == previous) return BadOutput(file, "is there twice");
    previous = file.name;
    POISE_ASSIGN_OR_RETURN(base::Json description, Describe(file));
    files.push_back(std::move(description));
  }
  base::Json manifest = {{"kind", input.spec.kind},    {"parameters", input.spec.parameters},
                         {"seed", input.seed},         {"input_sha256", InputHash(input)},
                         {"version", base::Version()}, {"files", std::move(files)}};
  if (!output.report.is_null()) manifest["report"] = output.report;
  OutputFile file{.name = kManifestName,
                  .path = input.folder / kManifestName,
                  .media_type = "application/json"};
  std::ofstream stream(file.path, std::ios::binary);
  stream << manifest.dump(2, ' ', false, base::Json::error_handler_t::replace) << "\n";
  stream.close();
  if (!stream.good()) {
    return base::ResourceExhausted("CANNOT_WRITE", "",
                                   fmt::format("cannot write {}", file.path.string()));
  }
  output.files.push_back(std::move(file));
  return output;
}

}  // namespace poise::jobs
