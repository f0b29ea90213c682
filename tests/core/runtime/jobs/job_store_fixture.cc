#include "tests/core/runtime/jobs/job_store_fixture.h"

#include <fmt/format.h>

#include <cstdlib>
#include <limits>

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

std::string JobStoreTest::Submit(const jobs::NewJob& job) {
  const auto outcome = store().Submit(job);
  EXPECT_TRUE(outcome.ok()) << outcome.status();
  return outcome.ok() ? outcome->job.id : "";
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
  EXPECT_TRUE(store()
                  .UpsertWorker({.id = worker,
                                 .host = "host",
                                 .engine = "local",
                                 .engine_ref = "",
                                 .version = "1",
                                 .last_seen = {}})
                  .ok());
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
