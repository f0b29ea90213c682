#include "core/runtime/jobs/sqlite_log.h"

#include <system_error>
#include <utility>

namespace poise::jobs::sqlite {
namespace {

namespace fs = std::filesystem;

// Four times what the log has when there are moments without readers.
constexpr int64_t kMaxLogBytes = int64_t{16} << 20;

// False when somebody else still reads, a backup perhaps, which is not waited for.
bool Trim(Connection& writer) {
  bool trimmed = false;
  const Status status = Caught([&] {
    writer.Script("PRAGMA busy_timeout = 0");
    Query row = writer.Prepare("PRAGMA wal_checkpoint(TRUNCATE)");
    trimmed = row.Step() && row.Int(0) == 0;
    return absl::OkStatus();
  });
  (void)Caught([&] { return writer.Script(kBusyTimeout), absl::OkStatus(); });
  return status.ok() && trimmed;
}

}  // namespace

fs::path LogOf(fs::path file) { return file += "-wal"; }

int64_t FileBytes(const fs::path& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  return error ? 0 : static_cast<int64_t>(size);
}

LogTrimmer::LogTrimmer(const fs::path& file, Readers& readers)
    : log_(LogOf(file)), readers_(readers), next_trim_bytes_(kMaxLogBytes) {}

void LogTrimmer::AfterCommit(Connection& writer) {
  const int64_t bytes = FileBytes(log_);
  if (bytes < next_trim_bytes_) return;
  bool trimmed = false;
  readers_.WhileIdle([&] { trimmed = Trim(writer); });
  next_trim_bytes_ = trimmed ? kMaxLogBytes : bytes + kMaxLogBytes;
}

}  // namespace poise::jobs::sqlite
