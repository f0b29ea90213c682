#include "tests/core/runtime/jobs/job_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace poise::testing {
namespace {

using api::AttemptOutcome;
using api::JobState;

bool MayFollow(std::optional<JobState> from, JobState to) {
  if (!from) return to == JobState::kQueued;
  switch (*from) {
    case JobState::kQueued:
      return to == JobState::kRunning || to == JobState::kCancelled || to == JobState::kFailed;
    case JobState::kRunning:
      return to != JobState::kRunning && to != JobState::kCancelled;
    case JobState::kCancelling:
      return to == JobState::kSucceeded || to == JobState::kCancelled;
    default:
      return false;  // terminal
  }
}

}  // namespace

void JobModel::OnTransition(const jobs::Transition& change) {
  std::lock_guard lock(mutex_);
  ++transitions_;
  Known& known = jobs_[change.job];
  Expect(known.state == change.from, change.job, "a change begins where the last one ended");
  Expect(MayFollow(change.from, change.to), change.job,
         fmt::format("{} may not follow {}", api::JobStateName(change.to), known.states));
  const bool starts = change.to == JobState::kRunning;
  Expect(change.attempt == known.attempt + (starts ? 1 : 0), change.job, "attempts count up");
  known.attempt = change.attempt;
  known.state = change.to;
  if (!known.states.empty()) known.states += ' ';
  known.states += api::JobStateName(change.to);
}

void JobModel::OnSubmitted(const std::string& request_id, const std::string& id) {
  std::lock_guard lock(mutex_);
  requests_[request_id].insert(id);
}

void JobModel::OnClaimed(const jobs::Fence& fence) {
  std::lock_guard lock(mutex_);
  Expect(jobs_[fence.job].claimed.insert(fence.attempt).second, fence.job,
         fmt::format("attempt {} was given to two workers", fence.attempt));
}

void JobModel::OnSuccess(const jobs::Fence& fence) {
  std::lock_guard lock(mutex_);
  jobs_[fence.job].succeeded.insert(fence.attempt);
}

void JobModel::OnDeleted(const std::string& id) {
  std::lock_guard lock(mutex_);
  deleted_.insert(id);
}

void JobModel::CheckAtTheEnd(jobs::JobStore& store) {
  std::lock_guard lock(mutex_);
  for (const auto& [id, known] : jobs_) {
    Expect(known.succeeded.size() == (known.state == JobState::kSucceeded ? 1 : 0), id,
           fmt::format("{} commits were acknowledged: {}", known.succeeded.size(), known.states));
    const auto job = store.Get("default", id);
    Expect(job.ok() != (deleted_.count(id) > 0), id, "a job is there unless it was deleted");
    const auto events = store.ReadEvents(id, 0, std::numeric_limits<int>::max());
    if (job.ok() && events.ok()) Check(id, known, *job, *events);
  }
  for (const auto& [request_id, ids] : requests_) {
    // It is free again when its job has been deleted.
    const auto left = std::count_if(ids.begin(), ids.end(),
                                    [&](const std::string& id) { return !deleted_.count(id); });
    Expect(left <= 1, *ids.begin(), "one request id made two jobs: " + request_id);
  }
  const auto stats = store.Stats();
  Expect(stats.ok() && stats->leases == 0, "store", "no lease is left");
  Expect(stats.ok() && stats->submitted == static_cast<int64_t>(jobs_.size()), "store",
         "every job that was made is counted");
  Expect(stats.ok() && stats->deleted == static_cast<int64_t>(deleted_.size()), "store",
         "every job that was deleted is counted");
}

void JobModel::Check(const std::string& id, const Known& known, const api::Job& job,
                     const std::vector<api::JobEvent>& events) {
  Expect(known.state == job.state && api::IsTerminal(job.state), id, "the job ended as announced");
  std::string states;
  int64_t change = 0;
  int64_t seq = 0;
  for (const api::JobEvent& event : events) {
    Expect(event.seq > seq, id, "numbers grow");
    Expect(event.change == change + (event.progress ? 0 : 1), id, "no change is missing");
    seq = event.seq;
    change = event.change;
    if (!event.state) continue;
    if (!states.empty()) states += ' ';
    states += api::JobStateName(*event.state);
  }
  Expect(states == known.states, id, fmt::format("events say {}, not {}", states, known.states));
  Expect(!events.empty() && events.back().state.has_value(), id, "the last event is the end");
  Expect(static_cast<int>(job.attempts.size()) == job.attempt, id, "every attempt is kept");
  for (const api::JobAttempt& attempt : job.attempts) {
    const bool succeeded = attempt.outcome == AttemptOutcome::kSucceeded;
    Expect(attempt.outcome != AttemptOutcome::kRunning, id, "every attempt has ended");
    Expect(succeeded == (known.succeeded.count(attempt.attempt) > 0), id,
           "the attempt that committed is the one that was told so");
  }
  Expect(job.errors <= job.limits.max_errors && job.losses <= job.limits.max_losses, id,
         "budgets hold");
}

void JobModel::Expect(bool fits, const std::string& id, const std::string& what) {
  if (!fits) faults_.push_back(fmt::format("job {}: {}", id, what));
}

std::vector<std::string> JobModel::faults() {
  std::lock_guard lock(mutex_);
  return faults_;
}

int64_t JobModel::jobs() {
  std::lock_guard lock(mutex_);
  return static_cast<int64_t>(jobs_.size());
}

int64_t JobModel::transitions() {
  std::lock_guard lock(mutex_);
  return transitions_;
}

}  // namespace poise::testing
