#ifndef POISE_SERVER_WORKER_WORK_FOLDER_H_
#define POISE_SERVER_WORKER_WORK_FOLDER_H_

#include <filesystem>
#include <memory>
#include <string>

#include "core/base/status.h"

namespace poise::worker {

/// The folder in which one worker's attempts write, <parent>/<worker>. It goes away with the
/// object; those of workers that were killed are removed by the next that starts. A lock on
/// <parent>/<worker>.lock, which ends with the process, tells which are in use.
class WorkFolder {
 public:
  /// Errors: kFailedPrecondition BAD_WORK_DIR.
  static StatusOr<std::unique_ptr<WorkFolder>> Create(const std::filesystem::path& parent,
                                                      const std::string& worker);
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  WorkFolder(std::filesystem::path path, int lock) : path_(std::move(path)), lock_(lock) {}

  const std::filesystem::path path_;
  const int lock_;
};

}  // namespace poise::worker

#endif  // POISE_SERVER_WORKER_WORK_FOLDER_H_
