#include "core/artifacts/model_registry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "absl/strings/numbers.h"

namespace poise::artifacts {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStaging = ".staging";  // no model's name begins with a dot
constexpr const char* kDefaultFile = "default";
constexpr const char* kLastFile = "last";  // the greatest number that a deleted version had

std::vector<fs::path> Folders(const fs::path& parent) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (fs::directory_iterator entry(parent, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->is_directory(error)) folders.push_back(entry->path());
  }
  return folders;
}

int64_t FolderBytes(const fs::path& folder) {
  int64_t bytes = 0;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    bytes += static_cast<int64_t>(entry->file_size(error));
  }
  return bytes;
}

// 0 for what is no number: a version that somebody named by hand.
int64_t VersionNumber(const std::string& version) {
  int64_t number = 0;
  return absl::SimpleAtoi(version, &number) ? number : 0;
}

// Empty where there is no such file.
std::string FirstWord(const fs::path& path) {
  std::ifstream file(path);
  std::string word;
  file >> word;
  return word;
}

Status CannotStore(const fs::path& path, const std::error_code& error) {
  return base::MakeError(absl::StatusCode::kUnavailable, "CANNOT_STORE", "",
                         fmt::format("cannot write '{}': {}", path.string(), error.message()));
}

// Whoever reads the file finds the old word or the new one.
Status ReplaceWord(const fs::path& staging, const fs::path& path, std::string_view word) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  std::ofstream stream(staging);
  stream << word << "\n";
  stream.close();
  if (stream.good() && !error) fs::rename(staging, path, error);
  return stream.good() && !error ? absl::OkStatus() : CannotStore(path, error);
}

}  // namespace

StatusOr<std::unique_ptr<ModelRegistry>> ModelRegistry::Open(ModelRegistryConfig config) {
  std::error_code error;
  fs::remove_all(config.root / kStaging, error);
  if (!error) fs::create_directories(config.root / kStaging, error);
  if (error || access(config.root.c_str(), W_OK) != 0) {
    return base::FailedPrecondition(
        "BAD_DATA_DIR", "data_dir",
        fmt::format("cannot write models below '{}'", config.root.string()));
  }
  return std::unique_ptr<ModelRegistry>(new ModelRegistry(std::move(config)));
}

std::vector<std::string> ModelRegistry::Names() const {
  std::set<std::string> names;
  for (const fs::path& root : {config_.root, config_.shipped}) {
    for (const fs::path& folder : Folders(root)) {
      const std::string name = folder.filename().string();
      if (api::CheckResourceName(name, "BAD_MODEL_NAME").ok() && !Folders(folder).empty()) {
        names.insert(name);
      }
    }
  }
  return {names.begin(), names.end()};
}

std::vector<ModelRegistry::Place> ModelRegistry::Versions(const std::string& name) const {
  std::vector<Place> places;
  for (const fs::path& folder : Folders(config_.shipped / name)) {
    places.push_back({folder.filename().string(), folder, true});
  }
  for (const fs::path& folder : Folders(config_.root / name)) {
    places.push_back({folder.filename().string(), folder, false});
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return std::pair(VersionNumber(a.version), a.version) <
           std::pair(VersionNumber(b.version), b.version);
  });
  return places;
}

std::string ModelRegistry::DefaultVersion(const std::string& name,
                                          const std::vector<Place>& places) const {
  const std::string version = FirstWord(config_.root / name / kDefaultFile);
  const bool there = std::any_of(places.begin(), places.end(),
                                 [&](const Place& place) { return place.version == version; });
  return there ? version : places.back().version;
}

StatusOr<ModelRegistry::Place> ModelRegistry::Find(const api::ModelReference& reference) const {
  const auto not_found = [](const std::string& message) {
    return base::NotFound("MODEL_NOT_FOUND", "model", message);
  };
  // A name from outside must not lead out of the folder.
  POISE_RETURN_IF_ERROR(api::CheckResourceName(reference.name, "BAD_MODEL_NAME"));
  const std::vector<Place> places = Versions(reference.name);
  if (places.empty()) {
    return not_found(fmt::format("there is no model '{}'; there are: {}", reference.name,
                                 fmt::join(Names(), ", ")));
  }
  const std::string wanted =
      reference.version.empty() ? DefaultVersion(reference.name, places) : reference.version;
  std::vector<std::string> versions;
  for (const Place& place : places) {
    if (place.version == wanted) return place;
    versions.push_back(place.version);
  }
  return not_found(fmt::format("model '{}' has no version '{}'; it has: {}", reference.name, wanted,
                               fmt::join(versions, ", ")));
}

StatusOr<ModelRegistry::Place> ModelRegistry::FindExact(
    const api::ModelReference& reference) const {
  if (!reference.version.empty()) return Find(reference);
  return base::InvalidArgument(
      "MISSING_VERSION", "model",
      fmt::format("say which version of '{}': {}@VERSION", reference.name, reference.name));
}

StatusOr<api::Model> ModelRegistry::Describe(const std::string& name, const Place& place) const {
  POISE_ASSIGN_OR_RETURN(api::ModelCard card, ReadModelCard(place.folder));
  return api::Model{.name = name,
                    .version = place.version,
                    .card = std::move(card),
                    .size_bytes = FolderBytes(place.folder),
                    .is_default = place.version == DefaultVersion(name, Versions(name)),
                    .shipped = place.shipped};
}

std::vector<api::Model> ModelRegistry::List(std::vector<std::string>* broken) const {
  std::lock_guard lock(mutex_);
  std::vector<api::Model> models;
  for (const std::string& name : Names()) {
    for (const Place& place : Versions(name)) {
      StatusOr<api::Model> model = Describe(name, place);
      if (model.ok()) {
        models.push_back(*std::move(model));
      } else if (broken != nullptr) {
        broken->push_back(base::Message(model.status()));
      }
    }
  }
  return models;
}

StatusOr<api::Model> ModelRegistry::Get(const api::ModelReference& reference) const {
  std::lock_guard lock(mutex_);
  POISE_ASSIGN_OR_RETURN(const Place place, Find(reference));
  return Describe(reference.name, place);
}

StatusOr<api::ModelReference> ModelRegistry::Resolve(const api::ModelReference& reference) const {
  std::lock_guard lock(mutex_);
  POISE_ASSIGN_OR_RETURN(Place place, Find(reference));
  return api::ModelReference{.name = reference.name, .version = std::move(place.version)};
}

// Others need not wait while the weights are read: what is in a folder never changes.
StatusOr<ModelArtifact> ModelRegistry::Load(const api::ModelReference& reference) const {
  std::unique_lock lock(mutex_);
  POISE_ASSIGN_OR_RETURN(const Place place, Find(reference));
  lock.unlock();
  StatusOr<ModelArtifact> model = ReadModelFolder(place.folder);
  if (model.ok()) return model;
  lock.lock();
  const Status deleted_meanwhile = Find(reference).status();
  return deleted_meanwhile.ok() ? model.status() : deleted_meanwhile;
}

StatusOr<api::Model> ModelRegistry::Import(const std::string& name, const ModelArtifact& model) {
  POISE_RETURN_IF_ERROR(api::CheckResourceName(name, "BAD_MODEL_NAME"));
  api::ModelCard card = model.card;
  card.weights_sha256 = WeightsDigest(model.weights);
  std::lock_guard lock(mutex_);
  int64_t newest = VersionNumber(FirstWord(config_.root / name / kLastFile));
  for (const Place& place : Versions(name)) {
    newest = std::max(newest, VersionNumber(place.version));
    const StatusOr<api::ModelCard> other = ReadModelCard(place.folder);
    if (other.ok() && *other == card) return Describe(name, place);
  }
  // Built where nobody looks, then given its name: half a model is never seen.
  const fs::path staging = config_.root / kStaging / ("import-" + name);
  const Place place{fmt::format("{}", newest + 1), config_.root / name / fmt::to_string(newest + 1),
                    false};
  std::error_code error;
  fs::remove_all(staging, error);
  if (!fs::create_directories(staging, error)) return CannotStore(staging, error);
  POISE_RETURN_IF_ERROR(WriteModelFolder(model, staging));
  fs::create_directories(place.folder.parent_path(), error);
  if (!error) fs::rename(staging, place.folder, error);
  if (error) return CannotStore(place.folder, error);
  ++generation_;
  return Describe(name, place);
}

StatusOr<api::Model> ModelRegistry::SetDefault(const api::ModelReference& reference) {
  std::lock_guard lock(mutex_);
  POISE_ASSIGN_OR_RETURN(const Place place, FindExact(reference));
  POISE_RETURN_IF_ERROR(ReplaceWord(config_.root / kStaging / kDefaultFile,
                                    config_.root / reference.name / kDefaultFile, place.version));
  ++generation_;
  return Describe(reference.name, place);
}

Status ModelRegistry::Delete(const api::ModelReference& reference) {
  std::lock_guard lock(mutex_);
  POISE_ASSIGN_OR_RETURN(const Place place, FindExact(reference));
  if (place.shipped) {
    return base::FailedPrecondition(
        "SHIPPED_MODEL", "model",
        fmt::format("model '{}' came with the program and cannot be deleted",
                    reference.ToString()));
  }
  // Its number is not given again: who remembers it would mean another model.
  const fs::path last = config_.root / reference.name / kLastFile;
  if (VersionNumber(place.version) > VersionNumber(FirstWord(last))) {
    POISE_RETURN_IF_ERROR(ReplaceWord(config_.root / kStaging / kLastFile, last, place.version));
  }
  const fs::path away = config_.root / kStaging / ("deleted-" + reference.name);
  std::error_code error;
  fs::rename(place.folder, away, error);
  if (error) return CannotStore(place.folder, error);
  ++generation_;
  fs::remove_all(away, error);
  return absl::OkStatus();
}

}  // namespace poise::artifacts
