#include "tests/core/runtime/jobs/random_caller.h"

#include <fmt/format.h>

namespace poise::testing {
namespace {

using api::AttemptOutcome;
using api::JobState;

constexpr size_t kRemembered = 8;
constexpr uint64_t kRequestIds = 40;  // few, so that callers meet

}  // namespace

RandomCaller::RandomCaller(jobs::JobStore& store, TestClock& clock, const jobs::JobPolicy& policy,
                           JobModel& model, int index, uint64_t seed)
    : store_(store),
      clock_(clock),
      policy_(policy),
      model_(model),
      worker_(fmt::format("worker-{}", index)),
      random_(base::DeriveSeed(seed, {static_cast<uint64_t>(index)})) {
  Note(store_.UpsertWorker({.id = worker_}));
}

void RandomCaller::CallOnce() {
  const double draw = random_.Uniform();
  if (draw < 0.15) return Submit();
  if (draw < 0.35) return Claim();
  if (draw < 0.55) return Finish();
  if (draw < 0.63) return Checkpoint();
  if (draw < 0.73) return Heartbeat();
  if (draw < 0.80) return Release();
  if (draw < 0.88) return CancelOrDelete();
  if (draw < 0.94) return Read();
  KeepHouse();
}

void RandomCaller::Submit() {
  jobs::NewJob job;
  job.request.spec.kind = "selftest";
  job.request.priority = static_cast<int>(random_.Index(3)) - 1;
  job.request.limits.max_losses = 3;
  if (random_.Uniform() < 0.2) job.request.limits.deadline = 5 * policy_.lease;
  job.request.request_id = random_.Uniform() < 0.5
                               ? fmt::format("shared-{}", random_.Index(kRequestIds))
                               : fmt::format("{}-{}", worker_, ++tokens_);
  const auto outcome = store_.Submit(job);
  Note(outcome.status());
  if (!outcome.ok()) return;
  model_.OnSubmitted(job.request.request_id, outcome->job.id);
  jobs_.push_back(outcome->job.id);
}

void RandomCaller::Claim() {
  const std::string token = fmt::format("{}-token-{}", worker_, ++tokens_);
  const auto lease = store_.Claim({.worker = worker_, .token = token});
  Note(lease.status());
  if (!lease.ok() || !*lease) return;
  model_.OnClaimed((*lease)->fence);
  if (held_.size() == kRemembered) held_.erase(held_.begin());
  held_.push_back({(*lease)->fence, (*lease)->checkpoint ? (*lease)->checkpoint->step : 0});
  if (random_.Uniform() < 0.1) {
    const auto again = store_.Claim({.worker = worker_, .token = token});
    Note(again.status());
    if (again.ok() && *again && (*again)->fence.attempt != (*lease)->fence.attempt) {
      model_.OnClaimed((*again)->fence);
      held_.push_back({(*again)->fence, 0});
    }
  }
}

jobs::Outcome RandomCaller::DrawOutcome() {
  switch (random_.Index(6)) {
    case 0:
      return ErrorWith(absl::StatusCode::kUnavailable);
    case 1:
      return ErrorWith(absl::StatusCode::kInvalidArgument);
    case 2:
      return EndedAs(AttemptOutcome::kStalled);
    case 3:
      return EndedAs(AttemptOutcome::kLost);
    default:
      return Success();
  }
}

void RandomCaller::Finish() {
  Held* const held = Draw();
  if (held == nullptr) return;
  const jobs::Outcome outcome = DrawOutcome();
  for (int repeat = random_.Uniform() < 0.2 ? 2 : 1; repeat > 0; --repeat) {
    const auto state = store_.Finish(held->fence, outcome);
    Note(state.status());
    if (state.ok() && outcome.outcome == AttemptOutcome::kSucceeded) model_.OnSuccess(held->fence);
  }
}

void RandomCaller::Checkpoint() {
  if (Held* const held = Draw()) {
    held->step += static_cast<int64_t>(random_.Index(20));
    Note(store_.CommitCheckpoint(held->fence, ArtifactName('c'), held->step));
  }
}

void RandomCaller::Heartbeat() {
  if (Held* const held = Draw()) {
    const base::Progress progress{.step = ++held->step, .message = ""};
    Note(store_.Heartbeat(held->fence, progress).status());
  }
}

void RandomCaller::Release() {
  if (const Held* const held = Draw()) Note(store_.Release(held->fence, {}));
}

void RandomCaller::CancelOrDelete() {
  if (jobs_.empty()) return;
  const std::string& id = jobs_[random_.Index(jobs_.size())];
  const auto job = store_.Get("default", id);
  if (!job.ok()) return;
  if (!api::IsTerminal(job->state)) {
    const Status status = store_.RequestCancel("default", id, worker_).status();
    if (ReasonOf(status) != "JOB_NOT_FOUND") Note(status);
  } else if (random_.Uniform() < 0.3) {
    const Status status = store_.Delete("default", id);
    if (status.ok()) model_.OnDeleted(id);
    if (ReasonOf(status) != "JOB_NOT_FOUND") Note(status);
  }
}

void RandomCaller::Read() {
  Note(store_.List({.page_size = 5}).status());
  const auto stats = store_.Stats();
  Note(stats.status());
  if (!stats.ok()) return;
  // The numbers add up at any moment.
  int64_t there = 0;
  int64_t running = 0;
  for (const auto& [tenant, states] : stats->jobs) {
    for (const auto& [state, count] : states) there += count;
    running += states.at(JobState::kRunning) + states.at(JobState::kCancelling);
  }
  EXPECT_EQ(stats->submitted, there + stats->deleted);
  EXPECT_EQ(stats->leases, running);
}

void RandomCaller::KeepHouse() {
  clock_.Advance(policy_.lease * random_.Uniform(0, 0.3));
  Note(store_.Reap().status());
}

RandomCaller::Held* RandomCaller::Draw() {
  return held_.empty() ? nullptr : &held_[random_.Index(held_.size())];
}

void RandomCaller::Note(const Status& status) {
  if (ReasonOf(status) == "LEASE_LOST") {
    ++lease_lost_;
  } else {
    EXPECT_TRUE(status.ok()) << status;
  }
}

}  // namespace poise::testing
