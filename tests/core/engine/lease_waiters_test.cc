#include "core/engine/lease_waiters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <random>
#include <thread>

#include "absl/time/clock.h"

namespace poise::engine {
namespace {

using ::testing::ElementsAre;

// Waiters that write down who was woken.
class LeaseWaitersTest : public ::testing::Test {
 protected:
  std::unique_ptr<LeaseWaiters::Waiter> Join(const std::string& name,
                                             std::vector<std::string> queues = {},
                                             std::vector<std::string> kinds = {}) {
    auto waiter = waiters_.Join({.worker = name, .token = "", .queues = queues, .kinds = kinds},
                                [this, name] { woken_.push_back(name); });
    waiter->Arm();
    return waiter;
  }

  LeaseWaiters waiters_;
  std::vector<std::string> woken_;
};

TEST_F(LeaseWaitersTest, OneJobWakesTheOneThatWaitsLongest) {
  const auto a = Join("a"), b = Join("b"), c = Join("c");
  waiters_.JobReady("selftest");
  EXPECT_THAT(woken_, ElementsAre("a"));
  waiters_.JobReady("selftest");
  EXPECT_THAT(woken_, ElementsAre("a", "b"));
  a->Arm();  // found nothing: waits again, behind the others
  waiters_.JobReady("selftest");
  waiters_.JobReady("selftest");
  waiters_.JobReady("selftest");
  EXPECT_THAT(woken_, ElementsAre("a", "b", "c", "a"));
}

TEST_F(LeaseWaitersTest, OneOfEachGroupThatMayRunTheKindIsWoken) {
  const auto any = Join("any"), other = Join("other", {}, {"training"});
  const auto night = Join("night", {"night"}, {"selftest", "training"});
  const auto same = Join("same", {"night"}, {"training", "selftest"});
  waiters_.JobReady("selftest");
  EXPECT_THAT(woken_, ::testing::UnorderedElementsAre("any", "night"));
}

TEST_F(LeaseWaitersTest, WhoWasWokenAndLeavesWakesTheNext) {
  auto a = Join("a");
  const auto b = Join("b");
  waiters_.JobReady("selftest");
  a.reset();
  EXPECT_THAT(woken_, ElementsAre("a", "b"));
}

TEST_F(LeaseWaitersTest, WhoLeavesUnwokenWakesNobody) {
  auto a = Join("a");
  const auto b = Join("b");
  a.reset();
  EXPECT_TRUE(woken_.empty());
}

TEST_F(LeaseWaitersTest, WhoGotAJobWakesTheNextForAnother) {
  const auto a = Join("a"), b = Join("b");
  a->PassOn();
  EXPECT_THAT(woken_, ElementsAre("b"));
}

TEST_F(LeaseWaitersTest, DrainWakesAll) {
  const auto a = Join("a"), b = Join("b"), c = Join("c", {"night"});
  waiters_.WakeAll();
  EXPECT_EQ(woken_.size(), 3u);
}

// A worker's sleep; shared, since a call that is under way may arrive after the waiter has left.
struct Sleep {
  std::mutex mutex;
  std::condition_variable changed;
  bool woken = false;
};

// Workers that wait for jobs, take them from a common heap, and sometimes go away when they are
// woken: whatever happens when, no job stays while a worker waits.
class LeaseWaitersRaceTest : public ::testing::Test {
 protected:
  static constexpr int kWorkers = 8;
  static constexpr int kJobs = 4000;

  bool Take() {
    for (int now = available_; now > 0;) {
      if (available_.compare_exchange_weak(now, now - 1)) return true;
    }
    return false;
  }

  // One long poll; false: gave up.
  bool WaitForOne(std::mt19937& random) {
    const auto sleep = std::make_shared<Sleep>();
    const auto waiter = waiters_.Join({}, [sleep] {
      std::lock_guard lock(sleep->mutex);
      sleep->woken = true;
      sleep->changed.notify_all();
    });
    for (;;) {
      waiter->Arm();
      if (Take()) {
        waiter->PassOn();
        return true;
      }
      std::unique_lock lock(sleep->mutex);
      // Longer than the test: nobody is saved by it.
      sleep->changed.wait_for(lock, std::chrono::minutes(2),
                              [&] { return sleep->woken || taken_ >= kJobs; });
      sleep->woken = false;
      if (taken_ >= kJobs || random() % 4 == 0) return false;
    }
  }

  void Work(unsigned seed) {
    std::mt19937 random(seed);
    while (taken_ < kJobs) {
      if (WaitForOne(random)) ++taken_;
    }
  }

  LeaseWaiters waiters_;
  std::atomic<int> available_ = 0;
  std::atomic<int> taken_ = 0;
};

TEST_F(LeaseWaitersRaceTest, NoJobStaysWhileAWorkerWaits) {
  std::vector<std::thread> workers;
  for (unsigned i = 0; i < kWorkers; ++i) workers.emplace_back([this, i] { Work(i); });
  for (int i = 0; i < kJobs; ++i) {
    ++available_;
    waiters_.JobReady("selftest");
    if (i % 64 == 0) absl::SleepFor(absl::Microseconds(200));
  }
  const absl::Time end = absl::Now() + absl::Minutes(1);
  while (taken_ < kJobs && absl::Now() < end) absl::SleepFor(absl::Milliseconds(1));
  EXPECT_EQ(taken_, kJobs);
  taken_ = kJobs;
  waiters_.WakeAll();
  for (std::thread& worker : workers) worker.join();
}

}  // namespace
}  // namespace poise::engine
