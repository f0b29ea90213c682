#ifndef POISE_TESTS_CORE_RUNTIME_JOBS_FRAGILE_DISK_H_
#define POISE_TESTS_CORE_RUNTIME_JOBS_FRAGILE_DISK_H_

#include <sqlite3.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <variant>
#include <vector>

#include "core/base/random.h"

namespace poise::testing {

/// Stands between SQLite and the disk: it knows which writes a sync has made durable, can fail, and
/// can lose its power. All databases that are opened while it lives go through it.
/// Threads: any.
class FragileDisk {
 public:
  struct Step {
    enum class Kind { kWrite, kSync } kind;
    std::string file;  ///< name without folder
  };

  FragileDisk();
  ~FragileDisk();
  FragileDisk(const FragileDisk&) = delete;
  FragileDisk& operator=(const FragileDisk&) = delete;

  /// Databases that are opened from now on use the disk beneath.
  void StopTakingPart();

  /// What happened since the last call, in order.
  std::vector<Step> TakeSteps();

  /// Writes into `folder` what is left of the files when the power fails now: all that was synced,
  /// and of the rest nothing, or with `random` any part.
  void LosePower(const std::filesystem::path& folder, base::Random* random = nullptr);

  /// Every write (SQLITE_FULL, SQLITE_IOERR_WRITE) or sync (SQLITE_IOERR_FSYNC) fails so from now
  /// on; SQLITE_OK: no more.
  void FailWrites(int error) { write_error_ = error; }
  void FailSyncs(int error) { sync_error_ = error; }

 private:
  friend struct FragileFile;
  struct Write {
    int64_t offset;
    std::string bytes;
  };
  struct Truncation {
    int64_t size;
  };
  using Change = std::variant<Write, Truncation>;
  struct Contents {
    std::string durable;
    std::vector<Change> pending;
  };

  static void Apply(const Change& change, std::string& bytes);
  void OnChange(const std::string& path, Change change);
  void OnSync(const std::string& path);
  void OnDelete(const std::string& path);

  sqlite3_vfs vfs_;
  sqlite3_vfs* const beneath_;
  std::mutex mutex_;
  std::map<std::string, Contents> files_;
  std::vector<Step> steps_;
  std::atomic<int> write_error_ = SQLITE_OK;
  std::atomic<int> sync_error_ = SQLITE_OK;
};

}  // namespace poise::testing

#endif  // POISE_TESTS_CORE_RUNTIME_JOBS_FRAGILE_DISK_H_
