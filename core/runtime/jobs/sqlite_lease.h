#ifndef POISE_CORE_RUNTIME_JOBS_SQLITE_LEASE_H_
#define POISE_CORE_RUNTIME_JOBS_SQLITE_LEASE_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/runtime/jobs/job_store.h"
#include "core/runtime/jobs/sqlite_connection.h"
#include "core/runtime/jobs/sqlite_writer.h"

namespace poise::jobs::sqlite {

/// What is stored instead of a lease token.
std::string TokenHash(const std::string& token);
Status LeaseLost(const Fence& fence);

/// A lease that was just taken out of the table; its attempt must be ended in this transaction.
struct EndedLease {
  int64_t job = 0;  ///< number
  int attempt = 0;
  std::string worker;
  std::optional<std::string> progress;  ///< JSON
  int64_t step = 0;
  bool progress_pending = false;  ///< the last progress was throttled
};

/// Ends the lease in the statement that checks the fence; nullopt when it does not fit.
std::optional<EndedLease> EndLease(Connection& db, const Fence& fence);
/// Ends the leases that match a condition on `leases`.
std::vector<EndedLease> EndLeases(Connection& db, std::string_view condition, int64_t parameter,
                                  int limit);
std::vector<EndedLease> EndLeasesOfWorker(Connection& db, const std::string& worker);

/// Ends the attempt as its outcome says, and the job unless it is tried again. Returns the job's
/// state.
StatusOr<api::JobState> EndAttempt(Transaction& t, const EndedLease& lease, const Outcome& outcome);

}  // namespace poise::jobs::sqlite

#endif  // POISE_CORE_RUNTIME_JOBS_SQLITE_LEASE_H_
