#include <fmt/format.h>

#include "tests/core/runtime/jobs/job_store_fixture.h"

// Every state against every call: what is allowed leads where the table says, and what is not
// changes nothing. A terminal state never changes.
namespace poise::testing {
namespace {

using api::AttemptOutcome;
using api::JobState;
using ::testing::ElementsAre;

// A job somewhere in its life, and the fence of its last attempt.
struct Subject {
  std::string id;
  jobs::Fence fence;
};

struct Rule {
  const char* from;
  const char* call;
  const char* reason;  // of the refusal; "" when the call is OK
  const char* to;
};

constexpr Rule kRules[] = {
    {"QUEUED", "claim", "", "RUNNING"},
    {"QUEUED", "heartbeat", "LEASE_LOST", "QUEUED"},
    {"QUEUED", "checkpoint", "LEASE_LOST", "QUEUED"},
    {"QUEUED", "succeed", "LEASE_LOST", "QUEUED"},
    {"QUEUED", "fail", "LEASE_LOST", "QUEUED"},
    {"QUEUED", "release", "LEASE_LOST", "QUEUED"},
    {"QUEUED", "cancel", "", "CANCELLED"},
    {"QUEUED", "delete", "JOB_NOT_TERMINAL", "QUEUED"},
    {"QUEUED", "reap", "", "QUEUED"},

    {"waits for a retry", "claim", "", "QUEUED"},
    {"waits for a retry", "heartbeat", "LEASE_LOST", "QUEUED"},
    {"waits for a retry", "checkpoint", "LEASE_LOST", "QUEUED"},
    {"waits for a retry", "succeed", "LEASE_LOST", "QUEUED"},
    {"waits for a retry", "fail for now", "", "QUEUED"},  // the same as before
    {"waits for a retry", "release", "LEASE_LOST", "QUEUED"},
    {"waits for a retry", "cancel", "", "CANCELLED"},
    {"waits for a retry", "delete", "JOB_NOT_TERMINAL", "QUEUED"},
    {"waits for a retry", "reap", "", "QUEUED"},

    {"RUNNING", "claim", "", "RUNNING"},
    {"RUNNING", "heartbeat", "", "RUNNING"},
    {"RUNNING", "checkpoint", "", "RUNNING"},
    {"RUNNING", "succeed", "", "SUCCEEDED"},
    {"RUNNING", "fail", "", "FAILED"},
    {"RUNNING", "fail for now", "", "QUEUED"},
    {"RUNNING", "stall", "", "QUEUED"},
    {"RUNNING", "vanish", "", "QUEUED"},
    {"RUNNING", "finish as running", "BAD_OUTCOME", "RUNNING"},
    {"RUNNING", "finish as released", "BAD_OUTCOME", "RUNNING"},
    {"RUNNING", "release", "", "QUEUED"},
    {"RUNNING", "cancel", "", "CANCELLING"},
    {"RUNNING", "delete", "JOB_NOT_TERMINAL", "RUNNING"},
    {"RUNNING", "reap", "", "RUNNING"},

    {"CANCELLING", "claim", "", "CANCELLING"},
    {"CANCELLING", "heartbeat", "", "CANCELLING"},
    {"CANCELLING", "checkpoint", "", "CANCELLING"},
    {"CANCELLING", "succeed", "", "SUCCEEDED"},
    {"CANCELLING", "fail", "", "CANCELLED"},
    {"CANCELLING", "fail for now", "", "CANCELLED"},
    {"CANCELLING", "stall", "", "CANCELLED"},
    {"CANCELLING", "vanish", "", "CANCELLED"},
    {"CANCELLING", "stop", "", "CANCELLED"},
    {"CANCELLING", "release", "", "CANCELLED"},
    {"CANCELLING", "cancel", "", "CANCELLING"},
    {"CANCELLING", "delete", "JOB_NOT_TERMINAL", "CANCELLING"},
    {"CANCELLING", "reap", "", "CANCELLING"},

    {"SUCCEEDED", "claim", "", "SUCCEEDED"},
    {"SUCCEEDED", "heartbeat", "LEASE_LOST", "SUCCEEDED"},
    {"SUCCEEDED", "checkpoint", "LEASE_LOST", "SUCCEEDED"},
    {"SUCCEEDED", "succeed", "", "SUCCEEDED"},  // the same as before
    {"SUCCEEDED", "fail", "LEASE_LOST", "SUCCEEDED"},
    {"SUCCEEDED", "release", "LEASE_LOST", "SUCCEEDED"},
    {"SUCCEEDED", "cancel", "", "SUCCEEDED"},
    {"SUCCEEDED", "delete", "", "gone"},
    {"SUCCEEDED", "reap", "", "SUCCEEDED"},

    {"FAILED", "claim", "", "FAILED"},
    {"FAILED", "heartbeat", "LEASE_LOST", "FAILED"},
    {"FAILED", "checkpoint", "LEASE_LOST", "FAILED"},
    {"FAILED", "succeed", "LEASE_LOST", "FAILED"},
    {"FAILED", "fail", "", "FAILED"},  // the same as before
    {"FAILED", "release", "LEASE_LOST", "FAILED"},
    {"FAILED", "cancel", "", "FAILED"},
    {"FAILED", "delete", "", "gone"},
    {"FAILED", "reap", "", "FAILED"},

    {"CANCELLED", "claim", "", "CANCELLED"},
    {"CANCELLED", "heartbeat", "LEASE_LOST", "CANCELLED"},
    {"CANCELLED", "checkpoint", "LEASE_LOST", "CANCELLED"},
    {"CANCELLED", "succeed", "LEASE_LOST", "CANCELLED"},
    {"CANCELLED", "stop", "", "CANCELLED"},  // the same as before
    {"CANCELLED", "release", "LEASE_LOST", "CANCELLED"},
    {"CANCELLED", "cancel", "", "CANCELLED"},
    {"CANCELLED", "delete", "", "gone"},
    {"CANCELLED", "reap", "", "CANCELLED"},
};

class TransitionTest : public JobStoreTest {
 protected:
  Subject Bring(std::string_view to) {
    const std::string id = Submit();
    if (to == "QUEUED") return {id, {id, 1, "nobody's"}};
    const jobs::Lease lease = Claim();
    EXPECT_EQ(lease.fence.job, id);
    if (to == "waits for a retry") Finish(lease, ErrorWith(absl::StatusCode::kUnavailable));
    if (to == "CANCELLING" || to == "CANCELLED") Cancel(id);
    if (to == "SUCCEEDED") Finish(lease, Success());
    if (to == "FAILED") Finish(lease, ErrorWith(absl::StatusCode::kInvalidArgument));
    if (to == "CANCELLED") Finish(lease, EndedAs(AttemptOutcome::kCancelled));
    return {id, lease.fence};
  }

  Status FinishAs(const Subject& subject, const jobs::Outcome& outcome) {
    return store().Finish(subject.fence, outcome).status();
  }

  Status Call(std::string_view call, const Subject& subject) {
    if (call == "claim") return TryClaim("another"), absl::OkStatus();
    if (call == "heartbeat") return store().Heartbeat(subject.fence, std::nullopt).status();
    if (call == "checkpoint") return store().CommitCheckpoint(subject.fence, "artifacts/c", 7);
    if (call == "succeed") return FinishAs(subject, Success());
    if (call == "fail") {
      return FinishAs(subject, ErrorWith(absl::StatusCode::kInvalidArgument));
    }
    if (call == "fail for now") {
      return FinishAs(subject, ErrorWith(absl::StatusCode::kUnavailable));
    }
    if (call == "stall") return FinishAs(subject, EndedAs(AttemptOutcome::kStalled));
    if (call == "vanish") return FinishAs(subject, EndedAs(AttemptOutcome::kLost));
    if (call == "stop") return FinishAs(subject, EndedAs(AttemptOutcome::kCancelled));
    if (call == "finish as running") return FinishAs(subject, EndedAs(AttemptOutcome::kRunning));
    if (call == "finish as released") return FinishAs(subject, EndedAs(AttemptOutcome::kReleased));
    if (call == "release") return store().Release(subject.fence, {});
    if (call == "cancel") return store().RequestCancel("default", subject.id, "me").status();
    if (call == "delete") return store().Delete("default", subject.id);
    if (call == "reap") return store().Reap().status();
    ADD_FAILURE() << "no call is named " << call;
    return absl::OkStatus();
  }

  std::string StateOf(const std::string& id) {
    const auto job = store().Get("default", id);
    return job.ok() ? api::JobStateName(job->state) : "gone";
  }
};

TEST_P(TransitionTest, EveryCallInEveryStateDoesWhatTheTableSays) {
  for (const Rule& rule : kRules) {
    SCOPED_TRACE(fmt::format("{}: {}", rule.from, rule.call));
    const Subject subject = Bring(rule.from);
    const std::string before = StateOf(subject.id);
    const int64_t seq = Get(subject.id).event_seq;
    EXPECT_EQ(ReasonOf(Call(rule.call, subject)), rule.reason);
    EXPECT_EQ(StateOf(subject.id), rule.to);
    if (before == rule.to && rule.call != std::string_view("checkpoint")) {
      EXPECT_EQ(Get(subject.id).event_seq, seq) << "no change, no event";
    }
    // Out of the way of the next.
    store().RequestCancel("default", subject.id, "end").IgnoreError();
    LoseAllWorkers();
  }
  ExpectSound();
}

TEST_P(TransitionTest, TheListenerIsToldOfEveryChangeInOrder) {
  const std::string id = Submit();
  clock_.Advance(absl::Seconds(3));
  Finish(Claim("w1"), ErrorWith(absl::StatusCode::kUnavailable));
  clock_.Advance(policy_.max_backoff);
  Claim("w2");
  clock_.Advance(absl::Seconds(2));
  Cancel(id);
  LoseAllWorkers();

  std::vector<std::string> told;
  for (const jobs::Transition& change : Transitions()) {
    told.push_back(fmt::format("{}>{} {} {} {}", change.from ? api::JobStateName(*change.from) : "",
                               api::JobStateName(change.to), change.attempt, change.worker,
                               change.error ? change.error->reason : "-"));
    EXPECT_EQ(change.job, id);
    EXPECT_EQ(change.kind, "selftest");
  }
  EXPECT_THAT(told, ElementsAre(">QUEUED 0  -", "QUEUED>RUNNING 1 w1 -",
                                "RUNNING>QUEUED 1 w1 BROKEN", "QUEUED>RUNNING 2 w2 -",
                                "RUNNING>CANCELLING 2  -", "CANCELLING>CANCELLED 2 w2 CANCELLED"));
  EXPECT_EQ(Transitions()[1].in_state, absl::Seconds(3));
  EXPECT_EQ(Transitions()[4].in_state, absl::Seconds(2));
  EXPECT_EQ(Transitions()[5].in_state, policy_.lease);
}

TEST_P(TransitionTest, ARefusedCallTellsTheListenerNothing) {
  const Subject done = Bring("SUCCEEDED");
  const size_t before = Transitions().size();
  EXPECT_EQ(ReasonOf(Call("fail", done)), "LEASE_LOST");
  EXPECT_EQ(ReasonOf(Call("cancel", done)), "");
  EXPECT_EQ(Transitions().size(), before);
}

TEST_P(TransitionTest, ExpiringAWorkerEndsItsLeasesAtOnceAndNobodyElses) {
  const std::string first = Submit();
  const std::string second = Submit();
  const jobs::Lease lost = Claim("dead");
  const jobs::Lease kept = Claim("alive");
  EXPECT_EQ(store().ExpireWorker("dead").value_or(-1), 1);
  EXPECT_EQ(StateOf(first), "QUEUED");
  EXPECT_EQ(Get(first).losses, 1);
  EXPECT_EQ(StateOf(second), "RUNNING");
  EXPECT_EQ(ReasonOf(store().Heartbeat(lost.fence, std::nullopt)), "LEASE_LOST");
  EXPECT_EQ(ReasonOf(store().Claim({"dead", "t", {}, {}})), "UNKNOWN_WORKER")
      << "ids are not used again";
  EXPECT_EQ(Finish(kept, Success()), JobState::kSucceeded);
  EXPECT_EQ(store().ExpireWorker("never seen").value_or(-1), 0);
}

INSTANTIATE_TEST_SUITE_P(Stores, TransitionTest, ::testing::ValuesIn(StoreKinds()), NameOfKind);

}  // namespace
}  // namespace poise::testing
