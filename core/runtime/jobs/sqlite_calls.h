#ifndef POISE_CORE_RUNTIME_JOBS_SQLITE_CALLS_H_
#define POISE_CORE_RUNTIME_JOBS_SQLITE_CALLS_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/runtime/jobs/job_store.h"
#include "core/runtime/jobs/sqlite_writer.h"

/// What the writing members of JobStore do, each inside one transaction. A name of a group is the
/// file that holds it.
namespace poise::jobs::sqlite {

// sqlite_submit.cc
StatusOr<SubmitOutcome> SubmitJob(Transaction& t, const NewJob& job);

// sqlite_claim.cc
Status UpsertWorker(Transaction& t, const WorkerInfo& worker);
StatusOr<std::optional<Lease>> ClaimJob(Transaction& t, const ClaimQuery& query);
/// Jobs whose time to be tried again has come become claimable.
void PromoteRetries(Transaction& t);
/// The worker is alive; written at most once in half a heartbeat interval.
void SeeWorker(Transaction& t, const std::string& worker);

// sqlite_attempt.cc: what a worker writes for its attempt.
StatusOr<HeartbeatReply> ExtendLease(Transaction& t, const Fence& fence,
                                     const std::optional<base::Progress>& progress);
StatusOr<api::Job> LeasedJob(Transaction& t, const Fence& fence);
Status SaveCheckpoint(Transaction& t, const Fence& fence, const std::string& artifact,
                      int64_t step);
StatusOr<api::JobState> FinishAttempt(Transaction& t, const Fence& fence, const Outcome& outcome);
Status ReleaseAttempt(Transaction& t, const Fence& fence, const api::JobUsage& usage);

// sqlite_cancel.cc
StatusOr<api::Job> CancelJob(Transaction& t, const std::string& tenant, const std::string& id,
                             const std::string& who);
Status DeleteJob(Transaction& t, const std::string& tenant, const std::string& id);

// sqlite_reap.cc: each ends at most `limit`, so that no call holds up the others for long; a
// number below `limit` means that nothing is left.
StatusOr<int64_t> ReapLeases(Transaction& t, int limit);
StatusOr<int64_t> ReapDeadlines(Transaction& t, int limit);
StatusOr<int64_t> ExpireWorkerLeases(Transaction& t, const std::string& worker);
StatusOr<int64_t> CollectJobs(Transaction& t, int limit);
StatusOr<int64_t> CollectEvents(Transaction& t, int limit);
Status CollectWorkers(Transaction& t);

}  // namespace poise::jobs::sqlite

#endif  // POISE_CORE_RUNTIME_JOBS_SQLITE_CALLS_H_
