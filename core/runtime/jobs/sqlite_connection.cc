#include "core/runtime/jobs/sqlite_connection.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>

namespace poise::jobs::sqlite {
namespace {

constexpr absl::Duration kRetryDelay = absl::Seconds(2);

// FULL syncs the log at every commit: what was acknowledged survives power loss. Undo data of
// savepoints stays in memory. A log that once grew is cut back at the next checkpoint.
constexpr char kWriterSettings[] = R"(
  PRAGMA journal_mode = WAL;
  PRAGMA synchronous = FULL;
  PRAGMA foreign_keys = ON;
  PRAGMA temp_store = MEMORY;
  PRAGMA cache_size = -65536;
  PRAGMA journal_size_limit = 67108864;
)";
constexpr char kReaderSettings[] = R"(
  PRAGMA query_only = ON;
  PRAGMA temp_store = MEMORY;
)";

}  // namespace

Query::~Query() { statement_->tryReset(); }

void Query::Bind(int index, int64_t value) { statement_->bind(index, value); }
void Query::Bind(int index, double value) { statement_->bind(index, value); }
void Query::Bind(int index, const std::string& value) { statement_->bind(index, value); }
void Query::Bind(int index, std::nullopt_t) { statement_->bind(index); }
void Query::Bind(int index, absl::Time value) {
  if (value == absl::InfiniteFuture()) {
    statement_->bind(index);
  } else {
    statement_->bind(index, int64_t{absl::ToUnixMillis(value)});
  }
}

bool Query::Step() { return statement_->executeStep(); }

bool Query::IsNull(int column) const { return statement_->isColumnNull(column); }
int64_t Query::Int(int column) const { return statement_->getColumn(column).getInt64(); }
double Query::Real(int column) const { return statement_->getColumn(column).getDouble(); }
std::string Query::Text(int column) const { return statement_->getColumn(column).getString(); }

absl::Time Query::Time(int column) const {
  return IsNull(column) ? absl::InfiniteFuture() : absl::FromUnixMillis(Int(column));
}

std::optional<std::string> Query::OptionalText(int column) const {
  return IsNull(column) ? std::nullopt : std::optional(Text(column));
}

Connection::Connection(const std::filesystem::path& path, Mode mode)
    : database_(std::make_unique<SQLite::Database>(
          path.string(),
          SQLite::OPEN_READWRITE | (mode == Mode::kWrite ? SQLite::OPEN_CREATE : 0) |
              SQLite::OPEN_NOMUTEX,
          kBusyTimeoutMs)) {
  database_->exec(mode == Mode::kWrite ? kWriterSettings : kReaderSettings);
}

Connection::~Connection() = default;

SQLite::Statement& Connection::Statement(std::string_view sql) {
  auto found = statements_.find(sql);
  if (found == statements_.end()) {
    std::string text(sql);
    auto statement = std::make_unique<SQLite::Statement>(*database_, text);
    found = statements_.emplace(std::move(text), std::move(statement)).first;
  }
  return *found->second;
}

int64_t Connection::Number(std::string_view sql) {
  Query query = Prepare(sql);
  query.Step();
  return query.Int(0);
}

int64_t Connection::Changes() const { return database_->getChanges(); }

void Connection::Script(const char* sql) { database_->exec(sql); }

bool Connection::InTransaction() const {
  return sqlite3_get_autocommit(database_->getHandle()) == 0;
}

Status StatusOfException() {
  try {
    throw;
  } catch (const SQLite::Exception& error) {
    switch (error.getErrorCode() & 0xff) {
      case SQLITE_CORRUPT:
      case SQLITE_NOTADB:
        return base::MakeError(absl::StatusCode::kDataLoss, "STORE_CORRUPT", "",
                               fmt::format("the job store's file is damaged: {}", error.what()));
      case SQLITE_FULL:
      case SQLITE_IOERR:
      case SQLITE_BUSY:
      case SQLITE_LOCKED:
      case SQLITE_CANTOPEN:
      case SQLITE_READONLY:
      case SQLITE_PROTOCOL:
      case SQLITE_NOMEM:
        return base::WithRetryDelay(
            base::MakeError(absl::StatusCode::kUnavailable, "STORE_UNAVAILABLE", "",
                            fmt::format("the job store cannot be used now: {}", error.what())),
            kRetryDelay);
      default:
        return base::Internal("INTERNAL", fmt::format("the job store: {}", error.what()));
    }
  } catch (const std::exception& error) {
    return base::Internal("INTERNAL", fmt::format("the job store: {}", error.what()));
  }
}

}  // namespace poise::jobs::sqlite
