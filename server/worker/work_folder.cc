#include "server/worker/work_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

namespace poise::worker {
namespace {

namespace fs = std::filesystem;

constexpr char kLockSuffix[] = ".lock";

// -1 when it cannot be had.
int Lock(const fs::path& path, int open_flags, int lock_flags) {
  const int file = open(path.c_str(), O_RDWR | O_CLOEXEC | open_flags, 0600);
  if (file >= 0 && flock(file, LOCK_EX | lock_flags) != 0) {
    close(file);
    return -1;
  }
  return file;
}

void RemoveAbandoned(const fs::path& parent) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(parent, error)) {
    if (entry.path().extension() != kLockSuffix) continue;
    const int lock = Lock(entry.path(), 0, LOCK_NB);
    if (lock < 0) continue;
    fs::path folder = entry.path();
    std::error_code ignored;
    fs::remove_all(folder.replace_extension(), ignored);
    fs::remove(entry.path(), ignored);
    close(lock);
  }
}

}  // namespace

StatusOr<std::unique_ptr<WorkFolder>> WorkFolder::Create(const fs::path& parent,
                                                         const std::string& worker) {
  std::error_code error;
  fs::create_directories(parent, error);
  const fs::path path = fs::absolute(parent, error) / worker;
  // One at a time: a new lock must not look abandoned to another that starts.
  const int guard = Lock(parent / ".lock", O_CREAT, 0);
  RemoveAbandoned(parent);
  const int lock = guard < 0 ? -1 : Lock(path.string() + kLockSuffix, O_CREAT | O_EXCL, LOCK_NB);
  if (guard >= 0) close(guard);
  const bool made = lock >= 0 && fs::create_directory(path, error) && !error;
  if (made) return std::unique_ptr<WorkFolder>(new WorkFolder(path, lock));
  if (lock >= 0) close(lock);
  return base::FailedPrecondition("BAD_WORK_DIR", "work_dir",
                                  fmt::format("cannot make {} to work in", path.string()));
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  fs::remove(path_.string() + kLockSuffix, ignored);
  close(lock_);
}

}  // namespace poise::worker
