#ifndef POISE_CORE_RUNTIME_JOBS_SQLITE_CONNECTION_H_
#define POISE_CORE_RUNTIME_JOBS_SQLITE_CONNECTION_H_

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "absl/time/time.h"
#include "core/base/status.h"

namespace SQLite {
class Database;
class Statement;
}  // namespace SQLite

/// SQLiteCpp behind what the store needs of it. Below this line a fault of the database is an
/// exception; Caught() at the edge of each transaction makes a status of it.
namespace poise::jobs::sqlite {

/// A prepared statement with its parameters bound; it is free for others when this goes away, so
/// only one Query per text may live at a time.
/// Times are stored as whole milliseconds, InfiniteFuture as NULL.
class Query {
 public:
  template <typename... Parameters>
  explicit Query(SQLite::Statement& statement, const Parameters&... parameters)
      : statement_(&statement) {
    int index = 0;
    (Bind(++index, parameters), ...);
  }
  ~Query();
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;

  void Bind(int index, int64_t value);
  void Bind(int index, int value) { Bind(index, static_cast<int64_t>(value)); }
  void Bind(int index, bool value) { Bind(index, static_cast<int64_t>(value)); }
  void Bind(int index, double value);
  void Bind(int index, const std::string& value);
  void Bind(int index, const char* value) { Bind(index, std::string(value)); }
  void Bind(int index, absl::Time value);
  void Bind(int index, std::nullopt_t value);
  template <typename T>
  void Bind(int index, const std::optional<T>& value) {
    value ? Bind(index, *value) : Bind(index, std::nullopt);
  }

  /// False when there is no further row.
  bool Step();

  // Of the row, by column from 0.
  bool IsNull(int column) const;
  int64_t Int(int column) const;
  double Real(int column) const;
  std::string Text(int column) const;
  absl::Time Time(int column) const;
  std::optional<std::string> OptionalText(int column) const;

 private:
  SQLite::Statement* statement_;
};

/// How long a connection waits for another one's lock; and what sets it anew.
inline constexpr int kBusyTimeoutMs = 5000;
inline constexpr const char* kBusyTimeout = "PRAGMA busy_timeout = 5000";

/// A connection that keeps its statements prepared.
/// Threads: one at a time.
class Connection {
 public:
  enum class Mode { kWrite, kRead };

  /// Throws when the file cannot be opened.
  Connection(const std::filesystem::path& path, Mode mode);
  ~Connection();

  /// A statement with its parameters: `for (Query row = db.Prepare(...); row.Step();)` reads it.
  template <typename... Parameters>
  Query Prepare(std::string_view sql, const Parameters&... parameters) {
    return Query(Statement(sql), parameters...);
  }

  /// Runs a statement to its end; returns how many rows it changed.
  template <typename... Parameters>
  int64_t Run(std::string_view sql, const Parameters&... parameters) {
    Query query(Statement(sql), parameters...);
    while (query.Step()) {
    }
    return Changes();
  }

  /// The first column of the only row.
  int64_t Number(std::string_view sql);

  /// Several statements, without parameters or results.
  void Script(const char* sql);

  /// False when a fault has already rolled the transaction back.
  bool InTransaction() const;

  SQLite::Database& database() { return *database_; }

 private:
  SQLite::Statement& Statement(std::string_view sql);
  int64_t Changes() const;

  std::unique_ptr<SQLite::Database> database_;
  std::map<std::string, std::unique_ptr<SQLite::Statement>, std::less<>> statements_;
};

/// What the exception in flight means: kDataLoss STORE_CORRUPT for a damaged file, kUnavailable
/// STORE_UNAVAILABLE with a retry time for a full disk and whatever else may pass.
Status StatusOfException();

inline Status StatusOf(const Status& status) { return status; }
template <typename T>
Status StatusOf(const StatusOr<T>& value) {
  return value.status();
}

/// Calls `work`, which returns a Status or a StatusOr, and makes a status of an exception.
template <typename Work>
auto Caught(Work&& work) -> decltype(work()) {
  try {
    return work();
  } catch (...) {
    return StatusOfException();
  }
}

}  // namespace poise::jobs::sqlite

#endif  // POISE_CORE_RUNTIME_JOBS_SQLITE_CONNECTION_H_
