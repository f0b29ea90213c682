#include <fmt/format.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/runtime/jobs/page_token.h"
#include "core/runtime/jobs/sqlite_reading.h"

namespace poise::jobs::sqlite {
namespace {

using api::JobState;

// How many rows of a tenant one page may look at when its filter matches few of them. Such a page
// is short, or empty, and has a token.
constexpr int64_t kMaxScan = 20'000;

// What a filter means in SQL, with its parameters in order.
struct Condition {
  std::string sql;
  std::vector<std::string> parameters;

  void Add(std::string_view term, std::vector<std::string> values) {
    sql += fmt::format(" AND {}", term);
    parameters.insert(parameters.end(), values.begin(), values.end());
  }
};

// What the indexes know.
Condition IndexedPart(const ListQuery& query) {
  Condition condition{"tenant = ?", {query.tenant}};
  if (query.filter.state) {
    const bool cancelling = *query.filter.state == JobState::kCancelling;
    condition.Add("state = ?", {cancelling ? "RUNNING" : api::JobStateName(*query.filter.state)});
  }
  return condition;
}

Condition OtherPart(const ListQuery& query) {
  const api::JobFilter& filter = query.filter;
  Condition condition;
  if (filter.state == JobState::kRunning) condition.Add("j.cancelled_by IS NULL", {});
  if (filter.state == JobState::kCancelling) condition.Add("j.cancelled_by IS NOT NULL", {});
  if (!filter.kind.empty()) condition.Add("j.kind = ?", {filter.kind});
  if (!filter.queue.empty()) condition.Add("j.queue = ?", {filter.queue});
  for (const auto& [key, value] : filter.labels) {
    condition.Add("json_extract(s.labels, ?) = ?", {fmt::format("$.\"{}\"", key), value});
  }
  return condition;
}

// The rows that one page looks at.
struct Window {
  Condition condition;
  int64_t before = 0;
  int64_t length = 0;

  std::string Sql() const {
    return fmt::format(
        "SELECT number FROM jobs WHERE {} AND number < ? ORDER BY number DESC LIMIT {}",
        condition.sql, length);
  }
  // Binds its parameters from 1; returns the next index.
  int Bind(Query& query) const {
    int index = 0;
    for (const std::string& parameter : condition.parameters) query.Bind(++index, parameter);
    query.Bind(++index, before);
    return index + 1;
  }
};

// The last row that a page looked at, when there may be more behind it.
std::optional<int64_t> EndOfScan(Connection& db, const Window& window) {
  Query row = db.Prepare(fmt::format("SELECT count(*), min(number) FROM ({})", window.Sql()));
  window.Bind(row);
  row.Step();
  return row.Int(0) == window.length ? std::optional(row.Int(1)) : std::nullopt;
}

}  // namespace

StatusOr<api::JobPage> ListJobs(Connection& db, const ListQuery& query) {
  POISE_ASSIGN_OR_RETURN(const int page_size, EffectivePageSize(query));
  POISE_ASSIGN_OR_RETURN(const auto after, ParsePageToken(query));
  const Condition other = OtherPart(query);
  const Window window{IndexedPart(query), after.value_or(std::numeric_limits<int64_t>::max()),
                      other.sql.empty() ? page_size + 1 : kMaxScan};
  api::JobPage page;
  int64_t last = 0;
  {
    Query row =
        db.Prepare(fmt::format("{}WHERE j.number IN ({}){} ORDER BY j.number DESC "
                               "LIMIT {}",
                               kSelectJob, window.Sql(), other.sql, page_size + 1));
    int index = window.Bind(row);
    for (const std::string& parameter : other.parameters) row.Bind(index++, parameter);
    while (row.Step()) {
      if (page.jobs.size() == static_cast<size_t>(page_size)) {
        page.next_page_token = MakePageToken(query, last);
        return page;
      }
      POISE_ASSIGN_OR_RETURN(api::Job job, ReadJob(row));
      last = row.Int(kNumberColumn);
      page.jobs.push_back(std::move(job));
    }
  }
  if (const auto end = EndOfScan(db, window)) page.next_page_token = MakePageToken(query, *end);
  return page;
}

}  // namespace poise::jobs::sqlite
