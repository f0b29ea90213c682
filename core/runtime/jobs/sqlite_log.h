#ifndef POISE_CORE_RUNTIME_JOBS_SQLITE_LOG_H_
#define POISE_CORE_RUNTIME_JOBS_SQLITE_LOG_H_

#include <cstdint>
#include <filesystem>

#include "core/runtime/jobs/sqlite_connection.h"
#include "core/runtime/jobs/sqlite_readers.h"

namespace poise::jobs::sqlite {

/// The log beside a database file, "FILE-wal".
std::filesystem::path LogOf(std::filesystem::path file);
/// 0 when there is no such file.
int64_t FileBytes(const std::filesystem::path& path);

/// Keeps the log small. SQLite copies it into the file now and then, but begins it anew only at a
/// moment in which nobody reads. Under steady load there is none and the log grows for ever: then
/// the readers are held for as long as the last copying takes.
/// Threads: the writer's.
class LogTrimmer {
 public:
  LogTrimmer(const std::filesystem::path& file, Readers& readers);

  /// To be called after each commit; mostly looks at the size only.
  void AfterCommit(Connection& writer);

 private:
  const std::filesystem::path log_;
  Readers& readers_;
  int64_t next_trim_bytes_;
};

}  // namespace poise::jobs::sqlite

#endif  // POISE_CORE_RUNTIME_JOBS_SQLITE_LOG_H_
