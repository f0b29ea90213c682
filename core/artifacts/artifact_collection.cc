// What ArtifactStore removes, and when.
#include <sys/stat.h>
#include <unistd.h>

#include <system_error>
#include <vector>

#include "core/artifacts/artifact_name.h"
#include "core/artifacts/artifact_store.h"

namespace poise::artifacts {
namespace {

namespace fs = std::filesystem;

bool WrittenBefore(const fs::path& path, absl::Time time) {
  struct stat info {};
  return stat(path.c_str(), &info) == 0 && absl::TimeFromTimespec(info.st_mtim) < time;
}

// A folder may change while it is read, and may go.
std::vector<fs::path> Entries(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    entries.push_back(entry->path());
  }
  return entries;
}

}  // namespace

int64_t ArtifactStore::Collect(const std::set<std::string>& keep, absl::Time stored_before) {
  int64_t removed = 0;
  for (const fs::path& folder : Entries(config_.root)) {
    if (folder.filename().string().size() != 2) continue;  // staging, uploads
    for (const fs::path& file : Entries(folder)) {
      const std::string digest = file.filename().string();
      if (!IsSha256(digest) || keep.contains(ArtifactName(digest))) continue;
      // Nobody may store or refresh it between the look at its age and its end.
      std::lock_guard lock(names_);
      if (WrittenBefore(file, stored_before) && unlink(file.c_str()) == 0) ++removed;
    }
  }
  return removed;
}

int64_t ArtifactStore::CollectUploads(absl::Time now) {
  {
    std::lock_guard lock(collection_mutex_);
    last_collection_ = now;
  }
  const absl::Time limit = now - config_.upload_retention;
  int64_t removed = 0;
  for (const fs::path& file : Entries(config_.root / "uploads")) {
    const std::string id = file.filename().string();
    if (uploads_.IsClaimed(id) || !WrittenBefore(file, limit)) continue;
    // Whoever comes back at this very moment begins anew.
    const UploadClaim claim = uploads_.Claim(id);
    if (claim.Lock().ok() && unlink(file.c_str()) == 0) ++removed;
  }
  return removed;
}

}  // namespace poise::artifacts
