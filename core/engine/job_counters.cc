#include "core/engine/job_counters.h"

#include <map>

namespace poise::engine {
namespace {

using api::JobState;

constexpr char kBytes[] = "poise_job_store_bytes";
constexpr char kBytesHelp[] = "Size of the job store's files";

bool IsRunning(JobState state) {
  return state == JobState::kRunning || state == JobState::kCancelling;
}

}  // namespace

JobCounters::JobCounters(base::Telemetry& telemetry)
    : telemetry_(telemetry),
      deleted_(telemetry.counter("poise_jobs_deleted_total",
                                 "Jobs removed, by a call or after their time", {})),
      queue_seconds_(
          telemetry.histogram("poise_job_queue_seconds", "Time that a job was QUEUED", {})),
      run_seconds_(telemetry.histogram("poise_job_run_seconds",
                                       "Time that a job was RUNNING or CANCELLING", {})),
      oldest_queued_(telemetry.gauge("poise_jobs_oldest_queued_seconds",
                                     "Age of the job that waits longest and could run", {})),
      leases_(telemetry.gauge("poise_job_leases", "Jobs that a worker has", {})),
      workers_(telemetry.gauge("poise_workers", "Workers heard of within their lease", {})),
      store_bytes_(telemetry.gauge(kBytes, kBytesHelp, {{"file", "database"}})),
      log_bytes_(telemetry.gauge(kBytes, kBytesHelp, {{"file", "log"}})) {}

void JobCounters::Count(const jobs::Transition& transition) {
  if (!transition.from) {
    telemetry_.counter("poise_jobs_submitted_total", "Jobs created", {{"kind", transition.kind}})
        .Increment();
    return;
  }
  telemetry_
      .counter("poise_job_transitions_total", "Changes of state",
               {{"kind", transition.kind},
                {"from", api::JobStateName(*transition.from)},
                {"to", api::JobStateName(transition.to)},
                {"reason", ReasonLabel(transition)}})
      .Increment();
  const double seconds = absl::ToDoubleSeconds(transition.in_state);
  if (*transition.from == JobState::kQueued) queue_seconds_.Observe(seconds);
  if (IsRunning(*transition.from)) run_seconds_.Observe(seconds);
}

void JobCounters::CountDeleted(int64_t jobs) { deleted_.Increment(static_cast<double>(jobs)); }

void JobCounters::Show(const jobs::StoreStats& stats, size_t workers) {
  std::map<JobState, int64_t> jobs = {{JobState::kQueued, 0},     {JobState::kRunning, 0},
                                      {JobState::kCancelling, 0}, {JobState::kSucceeded, 0},
                                      {JobState::kFailed, 0},     {JobState::kCancelled, 0}};
  for (const auto& [tenant, of_tenant] : stats.jobs) {
    for (const auto& [state, count] : of_tenant) jobs[state] += count;
  }
  for (const auto& [state, count] : jobs) {
    telemetry_.gauge("poise_jobs", "Jobs in the store", {{"state", api::JobStateName(state)}})
        .Set(static_cast<double>(count));
  }
  oldest_queued_.Set(absl::ToDoubleSeconds(stats.oldest_queued));
  leases_.Set(static_cast<double>(stats.leases));
  workers_.Set(static_cast<double>(workers));
  store_bytes_.Set(static_cast<double>(stats.file_bytes));
  log_bytes_.Set(static_cast<double>(stats.wal_bytes));
}

std::string JobCounters::ReasonLabel(const jobs::Transition& transition) {
  if (!transition.error) return "";
  std::lock_guard lock(mutex_);
  const std::string& reason = transition.error->reason;
  if (reasons_.contains(reason)) return reason;
  if (reasons_.size() >= kMaxReasons) return "OTHER";
  reasons_.insert(reason);
  return reason;
}

}  // namespace poise::engine
