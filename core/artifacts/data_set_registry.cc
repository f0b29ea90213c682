#include "core/artifacts/data_set_registry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <utility>

#include "absl/time/clock.h"
#include "core/api/model_card.h"
#include "core/motion/dataset/clip_set_file.h"

namespace poise::artifacts {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kMaxBytes = int64_t{4} << 30;
constexpr const char* kEnding = ".json";
constexpr int kIndent = 2;

StatusOr<api::DataSet> ReadRecord(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  POISE_ASSIGN_OR_RETURN(const base::Json json, base::ParseJson(text.str(), path.string()));
  return api::DataSetFromJson(json);
}

api::DataSet Describe(const motion::ClipSet& clips) {
  api::DataSet set;
  set.license = clips.license;
  set.notes = clips.notes;
  for (const motion::LabelledClip& labelled : clips.clips) {
    ++set.clips;
    set.frames += labelled.clip.num_frames();
    set.duration_s += labelled.clip.duration();
    if (!labelled.action.empty()) ++set.actions[labelled.action];
    if (!labelled.actor.empty()) ++set.actors[labelled.actor];
  }
  return set;
}

Status AtArtifact(const Status& status) {
  return base::MakeError(status.code(), base::ErrorReason(status), "artifact",
                         base::Message(status));
}

}  // namespace

StatusOr<std::unique_ptr<DataSetRegistry>> DataSetRegistry::Open(const fs::path& root,
                                                                 ArtifactStore& store) {
  std::error_code error;
  fs::create_directories(root, error);
  if (error || access(root.c_str(), W_OK) != 0) {
    return base::FailedPrecondition("BAD_DATA_DIR", "data_dir",
                                    fmt::format("cannot write data sets in '{}'", root.string()));
  }
  return std::unique_ptr<DataSetRegistry>(new DataSetRegistry(root, store));
}

StatusOr<api::DataSet> DataSetRegistry::Create(const std::string& name,
                                               const std::string& artifact) {
  POISE_RETURN_IF_ERROR(api::CheckResourceName(name, "BAD_DATA_SET_NAME"));
  const StatusOr<std::string> bytes = store_.ReadAll(artifact, kMaxBytes);
  if (!bytes.ok()) return AtArtifact(bytes.status());
  const StatusOr<motion::ClipSet> clips = motion::DecodeClipSet(*bytes, artifact);
  if (!clips.ok()) return AtArtifact(clips.status());
  api::DataSet set = Describe(*clips);
  set.name = name;
  set.artifact = artifact;
  set.size_bytes = static_cast<int64_t>(bytes->size());
  set.create_time = absl::FromUnixSeconds(absl::ToUnixSeconds(absl::Now()));

  std::lock_guard lock(mutex_);
  if (const StatusOr<api::DataSet> other = GetLocked(name); other.ok()) {
    if (other->artifact == artifact) return other;
    return base::MakeError(
        absl::StatusCode::kAlreadyExists, "DATA_SET_EXISTS", "name",
        fmt::format("there is a data set '{}' with other clips; delete it, or take another name",
                    name));
  }
  // From now on it is kept; it must not have been collected since it was read.
  const fs::path staging = root_ / "staging";
  std::ofstream stream(staging);
  stream << api::ToJson(set).dump(kIndent) << "\n";
  stream.close();
  std::error_code error;
  if (stream.good()) fs::rename(staging, RecordPath(name), error);
  if (!stream.good() || error) {
    return base::MakeError(absl::StatusCode::kUnavailable, "CANNOT_STORE", "",
                           fmt::format("cannot write '{}'", RecordPath(name).string()));
  }
  if (const StatusOr<ArtifactInfo> info = store_.Refresh(artifact); !info.ok()) {
    fs::remove(RecordPath(name), error);
    return AtArtifact(info.status());
  }
  return set;
}

StatusOr<api::DataSet> DataSetRegistry::GetLocked(const std::string& name) const {
  // A name from outside must not lead out of the folder.
  POISE_RETURN_IF_ERROR(api::CheckResourceName(name, "BAD_DATA_SET_NAME"));
  if (StatusOr<api::DataSet> set = ReadRecord(RecordPath(name)); set.ok()) return set;
  std::vector<std::string> names;
  for (const api::DataSet& set : ListLocked()) names.push_back(set.name);
  return base::NotFound(
      "DATA_SET_NOT_FOUND", "data",
      fmt::format("there is no data set '{}'; there are: {}", name, fmt::join(names, ", ")));
}

std::vector<api::DataSet> DataSetRegistry::ListLocked() const {
  std::vector<api::DataSet> sets;
  std::error_code error;
  for (fs::directory_iterator entry(root_, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().extension() != kEnding) continue;
    if (StatusOr<api::DataSet> set = ReadRecord(entry->path()); set.ok()) {
      sets.push_back(*std::move(set));
    }
  }
  std::sort(sets.begin(), sets.end(),
            [](const api::DataSet& a, const api::DataSet& b) { return a.name < b.name; });
  return sets;
}

StatusOr<api::DataSet> DataSetRegistry::Get(const std::string& name) const {
  std::lock_guard lock(mutex_);
  return GetLocked(name);
}

std::vector<api::DataSet> DataSetRegistry::List() const {
  std::lock_guard lock(mutex_);
  return ListLocked();
}

Status DataSetRegistry::Delete(const std::string& name) {
  std::lock_guard lock(mutex_);
  POISE_RETURN_IF_ERROR(GetLocked(name).status());
  std::error_code error;
  fs::remove(RecordPath(name), error);
  if (!error) return absl::OkStatus();
  return base::MakeError(absl::StatusCode::kUnavailable, "CANNOT_STORE", "",
                         fmt::format("cannot remove '{}'", RecordPath(name).string()));
}

std::vector<std::string> DataSetRegistry::Artifacts() const {
  std::vector<std::string> artifacts;
  for (const api::DataSet& set : List()) artifacts.push_back(set.artifact);
  return artifacts;
}

}  // namespace poise::artifacts
