#include "tests/core/runtime/jobs/job_store_fixture.h"

#include <fmt/format.h>

#include <cstdlib>
#include <latch>
#include <limits>
#include <thread>

namespace poise::testing {

using jobs::Fence;
using jobs::Lease;
using jobs::Outcome;

jobs::JobStore& JobStoreTest::store() {
  if (!store_) {
    auto opened = GetParam().open(folder_.path(), policy_, [this] { return clock_.Now(); });
    if (!opened.ok()) {
      ADD_FAILURE() << opened.status();
      std::abort();  // every call that follows would be on nothing
    }
    store_ = std::move(*opened);
    store_->SetListener({.on_transition =
                             [this](const jobs::Transition& transition) {
                               std::lock_guard lock(mutex_);
                               transitions_.push_back(transition);
                             },
                         .on_event = nullptr});
  }
  return *store_;
}

jobs::NewJob JobStoreTest::Request(const std::string& request_id) {
  jobs::NewJob job;
  job.request.spec.kind = "selftest";
  job.request.spec.parameters = {{"steps", 3}};
  job.request.request_id = request_id;
  job.content_digest = "digest";
  return job;
}

jobs::NewJob JobStoreTest::RequestOf(const std::string& tenant) {
  jobs::NewJob job = Request();
  job.tenant = tenant;
  return job;
}

std::string JobStoreTest::Submit(const jobs::NewJob& job) {
  const auto outcome = store().Submit(job);
  EXPECT_TRUE(outcome.ok()) << outcome.status();
  return outcome.ok() ? outcome->job.id : "";
}

void JobStoreTest::SubmitMany(const jobs::NewJob& job, int count) {
  constexpr int kThreads = 32;
  store();
  std::atomic<int> left = count;
  InParallel(kThreads, [&](int) {
    while (--left >= 0) Submit(job);
  });
}

api::Job JobStoreTest::Get(const std::string& id, const std::string& tenant) {
  auto job = store().Get(tenant, id);
  EXPECT_TRUE(job.ok()) << job.status();
  return job.ok() ? *job : api::Job{};
}

api::Job JobStoreTest::Cancel(const std::string& id) {
  auto job = store().RequestCancel("default", id, "tester");
  EXPECT_TRUE(job.ok()) << job.status();
  return job.ok() ? *job : api::Job{};
}

api::JobState JobStoreTest::Finish(const Lease& lease, const Outcome& outcome) {
  const auto state = store().Finish(lease.fence, outcome);
  EXPECT_TRUE(state.ok()) << state.status();
  return state.value_or(api::JobState::kRunning);
}

jobs::HeartbeatReply JobStoreTest::Heartbeat(const Lease& lease, int64_t step) {
  const auto reply = store().Heartbeat(lease.fence, base::Progress{.step = step, .message = ""});
  EXPECT_TRUE(reply.ok()) << reply.status();
  return reply.value_or(jobs::HeartbeatReply{});
}

void JobStoreTest::Checkpoint(const Lease& lease, int64_t step) {
  const Status status = store().CommitCheckpoint(lease.fence, ArtifactName('c'), step);
  EXPECT_TRUE(status.ok()) << status;
}

void JobStoreTest::Release(const Lease& lease) {
  const Status status = store().Release(lease.fence, {});
  EXPECT_TRUE(status.ok()) << status;
}

void JobStoreTest::LoseAllWorkers() {
  clock_.Advance(policy_.lease);
  Reap();
}

int64_t JobStoreTest::Reap() {
  const auto reaped = store().Reap();
  EXPECT_TRUE(reaped.ok()) << reaped.status();
  return reaped.value_or(-1);
}

std::vector<api::JobEvent> JobStoreTest::Events(const std::string& id) {
  auto events = store().ReadEvents(id, 0, std::numeric_limits<int>::max());
  EXPECT_TRUE(events.ok()) << events.status();
  return events.ok() ? *events : std::vector<api::JobEvent>{};
}

std::optional<Lease> JobStoreTest::TryClaim(const std::string& worker, jobs::ClaimQuery query) {
  EXPECT_TRUE(
      store().UpsertWorker({.id = worker, .host = "host", .engine = "local", .version = "1"}).ok());
  query.worker = worker;
  if (query.token.empty()) query.token = fmt::format("token-{}", ++tokens_);
  auto lease = store().Claim(query);
  EXPECT_TRUE(lease.ok()) << lease.status();
  return lease.ok() ? *lease : std::nullopt;
}

Lease JobStoreTest::Claim(const std::string& worker) {
  auto lease = TryClaim(worker);
  EXPECT_TRUE(lease.has_value()) << "no job to claim";
  return lease.value_or(Lease{});
}

std::string JobStoreTest::RunJob(const Outcome& outcome) {
  const std::string id = Submit();
  const Lease lease = Claim();
  EXPECT_EQ(lease.fence.job, id) << "another job was waiting";
  Finish(lease, outcome);
  return id;
}

std::string JobStoreTest::StateHistory(const std::string& id) {
  std::string history;
  int64_t seq = 0;
  int64_t change = 0;
  for (const api::JobEvent& event : Events(id)) {
    EXPECT_GT(event.seq, seq);
    EXPECT_EQ(event.change, event.progress ? change : change + 1) << "event " << event.seq;
    seq = event.seq;
    change = event.change;
    if (event.state) {
      history += fmt::format("{}{}", history.empty() ? "" : " ", api::JobStateName(*event.state));
    }
  }
  return history;
}

void JobStoreTest::ExpectSound() {
  const auto findings = store().Diagnose();
  ASSERT_TRUE(findings.ok()) << findings.status();
  for (const jobs::Finding& finding : *findings) {
    EXPECT_NE(finding.severity, jobs::Finding::Severity::kFault)
        << finding.check << ": " << finding.message;
  }
}

std::vector<jobs::Transition> JobStoreTest::Transitions() {
  std::lock_guard lock(mutex_);
  return transitions_;
}

void InParallel(int count, const std::function<void(int)>& work) {
  std::latch start(count);
  std::vector<std::thread> threads;
  for (int i = 0; i < count; ++i) {
    threads.emplace_back([&, i] {
      start.arrive_and_wait();
      work(i);
    });
  }
  for (std::thread& thread : threads) thread.join();
}

std::string ArtifactName(char digit) { return "artifacts/" + std::string(64, digit); }

Outcome Success() { return EndedAs(api::AttemptOutcome::kSucceeded); }

Outcome ErrorWith(absl::StatusCode code) {
  Outcome outcome = EndedAs(api::AttemptOutcome::kError);
  outcome.error = api::JobError{
      .code = code, .reason = "BROKEN", .message = "it broke", .field = "spec.parameters.steps"};
  return outcome;
}

Outcome EndedAs(api::AttemptOutcome outcome) { return {.outcome = outcome}; }

std::string ReasonOf(const Status& status) { return status.ok() ? "" : base::ErrorReason(status); }

}  // namespace poise::testing
