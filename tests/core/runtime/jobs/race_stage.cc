#include "tests/core/runtime/jobs/race_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "core/base/identifier.h"

namespace poise::testing {

using api::JobState;

std::string RaceStage::Submit(absl::Duration deadline) {
  jobs::NewJob job;
  job.request.limits.deadline = deadline;
  job.request.spec.kind = "selftest";
  const auto outcome = store_.Submit(job);
  if (!outcome.ok()) std::abort();
  return outcome->job.id;
}

std::optional<jobs::Lease> RaceStage::TryClaim(const std::string& worker,
                                               const std::string& token) {
  if (!store_.UpsertWorker({.id = worker}).ok()) std::abort();
  const auto lease = store_.Claim({.worker = worker, .token = token});
  if (!lease.ok()) std::abort();
  return *lease;
}

jobs::Lease RaceStage::Claim(const std::string& worker) {
  const auto lease = TryClaim(worker, base::RandomHex(8));
  Promise(lease.has_value(), worker + " finds a job to claim");
  return lease.value_or(jobs::Lease{});
}

void RaceStage::ReapSilentWorkers() { ReapAfter(policy_.lease); }

void RaceStage::ReapAfter(absl::Duration time) {
  clock_.Advance(time);
  Promise(store_.Reap().ok(), "the reaper works");
}

HeldCall<StatusOr<JobState>> RaceStage::HeldFinish(const jobs::Fence& fence,
                                                   const jobs::Outcome& outcome) {
  return {"store.finish", [=, this] { return store_.Finish(fence, outcome); }};
}

HeldCall<Status> RaceStage::HeldCheckpoint(const jobs::Fence& fence, char digit, int64_t step) {
  return {"store.checkpoint",
          [=, this] { return store_.CommitCheckpoint(fence, ArtifactName(digit), step); }};
}

HeldCall<StatusOr<jobs::HeartbeatReply>> RaceStage::HeldHeartbeat(const jobs::Fence& fence,
                                                                  int64_t step) {
  return {"store.heartbeat", [=, this] {
            return store_.Heartbeat(fence, base::Progress{.step = step, .message = ""});
          }};
}

HeldCall<Status> RaceStage::HeldRelease(const jobs::Fence& fence) {
  return {"store.release", [=, this] { return store_.Release(fence, {}); }};
}

HeldCall<Status> RaceStage::HeldCancel(const std::string& id) {
  return {"store.cancel",
          [=, this] { return store_.RequestCancel("default", id, "tester").status(); }};
}

HeldCall<StatusOr<int64_t>> RaceStage::HeldReap() {
  return {"store.reap", [this] { return store_.Reap(); }};
}

HeldCall<std::optional<jobs::Lease>> RaceStage::HeldClaim(const std::string& worker) {
  return {"store.claim", [=, this] { return TryClaim(worker, base::RandomHex(8)); }};
}

void RaceStage::Promise(bool held, const std::string& what) {
  if (!held) broken_.push_back(what);
}

void RaceStage::PromiseLeaseLost(const Status& status, const std::string& who) {
  Promise(ReasonOf(status) == "LEASE_LOST",
          fmt::format("{} is refused, and not: {}", who, status.ok() ? "OK" : ReasonOf(status)));
}

void RaceStage::PromiseState(const std::string& id, JobState state) {
  Promise(Get(id).state == state, fmt::format("the job is {}, and not {}", api::JobStateName(state),
                                              api::JobStateName(Get(id).state)));
  PromiseSoundStory(id);
}

api::Job RaceStage::Get(const std::string& id) {
  auto job = store_.Get("default", id);
  if (!job.ok()) std::abort();
  return *job;
}

void RaceStage::PromiseSoundStory(const std::string& id) {
  const api::Job job = Get(id);
  const auto events = store_.ReadEvents(id, 0, std::numeric_limits<int>::max());
  if (!events.ok()) std::abort();
  int64_t change = 0;
  int terminal = 0;
  for (const api::JobEvent& event : *events) {
    Promise(event.change == change + (event.progress ? 0 : 1), "no change is missing");
    change = event.change;
    terminal += event.state && api::IsTerminal(*event.state);
  }
  Promise(terminal == (api::IsTerminal(job.state) ? 1 : 0), "a job ends once");
  int succeeded = 0;
  int running = 0;
  for (const api::JobAttempt& attempt : job.attempts) {
    succeeded += attempt.outcome == api::AttemptOutcome::kSucceeded;
    running += attempt.outcome == api::AttemptOutcome::kRunning;
  }
  Promise(succeeded == (job.state == JobState::kSucceeded ? 1 : 0), "one attempt commits");
  const bool runs = job.state == JobState::kRunning || job.state == JobState::kCancelling;
  Promise(running == (runs ? 1 : 0), "one attempt runs while the job does");
  Promise(static_cast<int>(job.attempts.size()) == job.attempt, "every attempt is kept");
}

jobs::Outcome SuccessWith(char digit) {
  jobs::Outcome outcome = Success();
  outcome.artifacts = {{"out", ArtifactName(digit), 1, "text/plain"}};
  return outcome;
}

}  // namespace poise::testing
