#ifndef POISE_CORE_RUNTIME_JOBS_SQLITE_READERS_H_
#define POISE_CORE_RUNTIME_JOBS_SQLITE_READERS_H_

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "core/runtime/jobs/sqlite_connection.h"

namespace poise::jobs::sqlite {

/// Connections that only read, beside the writer, each call on one snapshot. Reads are short: the
/// log cannot be cut back while one lasts.
class Readers {
 public:
  /// Throws when the file cannot be opened.
  Readers(const std::filesystem::path& path, int count);

  /// Calls `work(connection)`, which returns a Status or a StatusOr.
  template <typename Work>
  auto Run(Work&& work) -> decltype(work(std::declval<Connection&>())) {
    std::unique_ptr<Connection> connection = Take();
    auto result = Caught([&] {
      connection->Run("BEGIN");
      return work(*connection);
    });
    if (connection->InTransaction()) {
      (void)Caught([&] { return connection->Run("ROLLBACK"), absl::OkStatus(); });
    }
    Return(std::move(connection));
    return result;
  }

  /// Calls `work` while none of them reads; who comes meanwhile waits.
  void WhileIdle(const std::function<void()>& work);

 private:
  std::unique_ptr<Connection> Take();
  void Return(std::unique_ptr<Connection> connection);

  std::mutex mutex_;
  std::condition_variable returned_;
  std::vector<std::unique_ptr<Connection>> idle_;
  bool held_ = false;
  const size_t count_;
};

}  // namespace poise::jobs::sqlite

#endif  // POISE_CORE_RUNTIME_JOBS_SQLITE_READERS_H_
