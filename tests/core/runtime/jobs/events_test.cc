#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "tests/core/runtime/jobs/job_store_fixture.h"

// A job's event stream: every state and checkpoint, as much progress as is worth keeping.
namespace poise::testing {
namespace {

using api::JobState;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class EventsTest : public JobStoreTest {
 protected:
  std::vector<api::JobEvent> EventsAfter(const std::string& id, int64_t seq, int limit = 1000) {
    auto events = store().ReadEvents(id, seq, limit);
    EXPECT_TRUE(events.ok()) << events.status();
    return events.ok() ? *events : std::vector<api::JobEvent>{};
  }
  // "state QUEUED", "step 3", "checkpoint 10", in order.
  std::vector<std::string> Told(const std::string& id, int64_t after = 0) {
    std::vector<std::string> told;
    for (const api::JobEvent& event : EventsAfter(id, after)) {
      if (event.state) told.push_back(fmt::format("state {}", api::JobStateName(*event.state)));
      if (event.progress) told.push_back(fmt::format("step {}", event.progress->step));
      if (event.checkpoint) told.push_back(fmt::format("checkpoint {}", event.checkpoint->step));
    }
    return told;
  }
};

TEST_P(EventsTest, TellTheWholeStoryInOrder) {
  const std::string id = Submit();
  clock_.Advance(absl::Seconds(1));
  const jobs::Lease lease = Claim();
  Heartbeat(lease, 1);
  Checkpoint(lease, 10);
  clock_.Advance(absl::Seconds(1));
  Heartbeat(lease, 11);
  Finish(lease, ErrorWith(absl::StatusCode::kInternal));
  EXPECT_THAT(Told(id), ElementsAre("state QUEUED", "state RUNNING", "step 1", "checkpoint 10",
                                    "step 11", "state FAILED"));
  const auto events = Events(id);
  EXPECT_EQ(events[0].time, clock_.Now() - absl::Seconds(2));
  EXPECT_EQ(events[0].attempt, 0);
  EXPECT_EQ(events[5].attempt, 1);
  EXPECT_EQ(events[5].error->reason, "BROKEN");
  EXPECT_EQ(Get(id).event_seq, events[5].seq);
  std::vector<int64_t> changes;
  for (const api::JobEvent& event : events) changes.push_back(event.change);
  EXPECT_THAT(changes, ElementsAre(1, 2, 2, 3, 3, 4)) << "progress repeats the last change's";
}

TEST_P(EventsTest, AreReadFromAnyPlaceOn) {
  const std::string id = RunJob(Success());
  EXPECT_THAT(Told(id, 1), ElementsAre("state RUNNING", "state SUCCEEDED"));
  EXPECT_THAT(EventsAfter(id, 3), IsEmpty());
  EXPECT_THAT(EventsAfter(id, 999), IsEmpty());
  EXPECT_THAT(EventsAfter(id, -5), SizeIs(3));
  EXPECT_THAT(EventsAfter(id, 0, 2), SizeIs(2));
  EXPECT_THAT(EventsAfter(id, 0, 0), IsEmpty());
  EXPECT_THAT(EventsAfter(id, 0, -1), IsEmpty());
}

TEST_P(EventsTest, OfProgressOnlyTheLastIsGiven) {
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  for (int step = 1; step <= 5; ++step) {
    Heartbeat(lease, step);
    clock_.Advance(policy_.progress_interval);
  }
  EXPECT_THAT(Told(id), ElementsAre("state QUEUED", "state RUNNING", "step 5"));
  EXPECT_EQ(EventsAfter(id, 0).back().seq, 7) << "the others were there, and are skipped";
}

TEST_P(EventsTest, ProgressIsKeptAtMostOncePerInterval) {
  policy_.progress_interval = absl::Seconds(1);
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  for (int step = 1; step <= 100; ++step) {
    Heartbeat(lease, step);
    clock_.Advance(absl::Milliseconds(100));
  }
  EXPECT_LE(store().Stats()->events, 2 + 11) << "of 100 heartbeats in 10 seconds";
  EXPECT_GE(store().Stats()->events, 2 + 9);
  EXPECT_EQ(Get(id).progress.step, 100) << "the job itself knows the last one";
}

TEST_P(EventsTest, TheFirstAndTheLastProgressAreNeverDropped) {
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  Heartbeat(lease, 1);
  EXPECT_THAT(Told(id), ElementsAre("state QUEUED", "state RUNNING", "step 1"));
  Heartbeat(lease, 2);
  Heartbeat(lease, 3);
  Finish(lease, Success());
  EXPECT_THAT(Told(id, 3), ElementsAre("step 3", "state SUCCEEDED"));
}

TEST_P(EventsTest, ThrottledProgressIsToldByALaterHeartbeat) {
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  Heartbeat(lease, 1);
  Heartbeat(lease, 2);
  clock_.Advance(policy_.progress_interval);
  EXPECT_TRUE(store().Heartbeat(lease.fence, std::nullopt).ok());
  EXPECT_THAT(Told(id, 3), ElementsAre("step 2"));
}

TEST_P(EventsTest, TheSameProgressAgainIsNoEvent) {
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  for (int i = 0; i < 5; ++i) {
    Heartbeat(lease, 7);
    clock_.Advance(policy_.progress_interval);
  }
  EXPECT_EQ(Get(id).event_seq, 3);
}

TEST_P(EventsTest, ProgressOfALongJobIsThinnedOut) {
  policy_.max_progress_events = 20;
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  for (int step = 1; step <= 300; ++step) {
    Heartbeat(lease, step);
    clock_.Advance(policy_.progress_interval);
    ASSERT_LE(store().Stats()->events, 2 + 20 + 1) << step;
  }
  Finish(lease, Success());
  EXPECT_GE(store().Stats()->events, 3 + 20 / 2);
  EXPECT_EQ(StateHistory(id), "QUEUED RUNNING SUCCEEDED") << "changes are never thinned out";
  EXPECT_EQ(Events(id).back().seq, 303) << "numbers grow all the same";
  ExpectSound();
}

TEST_P(EventsTest, NumbersThatAreNoneSurvive) {
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  base::Progress progress{.step = 1, .message = "a\xff\"z"};
  progress.metrics = {{"loss", std::numeric_limits<double>::quiet_NaN()}, {"reward", -1e300}};
  ASSERT_TRUE(store().Heartbeat(lease.fence, progress).ok());
  const base::Progress stored = Get(id).progress;
  EXPECT_TRUE(std::isnan(stored.metrics.at("loss")));
  EXPECT_EQ(stored.metrics.at("reward"), -1e300);
  EXPECT_EQ(stored.message, "a\xef\xbf\xbd\"z");
}

TEST_P(EventsTest, OldEventsGoButTheTerminalOneStays) {
  policy_.event_retention = absl::Hours(1);
  const std::string ended = RunJob(Success());
  const std::string runs = Submit();
  Claim();
  clock_.Advance(absl::Hours(1) - absl::Milliseconds(1));
  EXPECT_TRUE(store().CollectExpired().ok());
  EXPECT_THAT(Events(ended), SizeIs(3));
  clock_.Advance(absl::Milliseconds(1));
  EXPECT_EQ(store().CollectExpired().value_or(-1), 0) << "no job goes with them";
  EXPECT_THAT(Told(ended), ElementsAre("state SUCCEEDED"));
  EXPECT_EQ(EventsAfter(ended, 0).front().seq, 3);
  EXPECT_THAT(Told(runs), ElementsAre("state QUEUED", "state RUNNING"));
  ExpectSound();
}

INSTANTIATE_TEST_SUITE_P(Stores, EventsTest, ::testing::ValuesIn(StoreKinds()), NameOfKind);

}  // namespace
}  // namespace poise::testing
