#include "core/engine/job_maintenance.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

#include "absl/time/clock.h"

namespace poise::engine {
namespace {

class CountingLog : public JobLog {
 public:
  void OnTaskFailed(std::string_view task, const Status& status) override {
    ++lines;
    last = std::string(task) + ": " + base::ErrorReason(status);
  }
  std::atomic<int> lines = 0;
  std::string last;
};

TEST(JobMaintenanceTest, TasksRunAgainAndAgain) {
  JobMaintenance maintenance(JobLog::None());
  std::atomic<int> runs = 0;
  maintenance.Start({{"count", absl::Milliseconds(5), [&] { return ++runs, absl::OkStatus(); }}});
  while (runs < 10) absl::SleepFor(absl::Milliseconds(1));
}

TEST(JobMaintenanceTest, FailingTaskIsToldAtMostOnceASecondAndTriedAgain) {
  CountingLog log;
  std::atomic<int> runs = 0;
  const absl::Time begin = absl::Now();
  {
    JobMaintenance maintenance(log);
    maintenance.Start({{"reap", absl::Milliseconds(1), [&] {
                          ++runs;
                          return base::MakeError(absl::StatusCode::kUnavailable,
                                                 "STORE_UNAVAILABLE", "", "no disk");
                        }}});
    while (runs < 200) absl::SleepFor(absl::Milliseconds(1));
  }
  EXPECT_GE(log.lines, 1);
  EXPECT_LE(log.lines, 1 + absl::ToInt64Seconds(absl::Now() - begin));
  EXPECT_EQ(log.last, "reap: STORE_UNAVAILABLE");
}

TEST(JobMaintenanceTest, ActionsRunAtTheirTimeInOrder) {
  JobMaintenance maintenance(JobLog::None());
  maintenance.Start({});
  const absl::Time now = absl::Now();
  std::promise<absl::Time> second;
  std::atomic<int> runs = 0;
  maintenance.RunAt(now + absl::Milliseconds(60), [&] {
    EXPECT_EQ(++runs, 2);
    second.set_value(absl::Now());
  });
  maintenance.RunAt(now + absl::Milliseconds(20), [&] { EXPECT_EQ(++runs, 1); });
  EXPECT_GE(second.get_future().get(), now + absl::Milliseconds(60));
}

TEST(JobMaintenanceTest, StopDoesNotWaitForTheNextTurn) {
  const absl::Time begin = absl::Now();
  {
    JobMaintenance maintenance(JobLog::None());
    maintenance.Start({{"rare", absl::Hours(1), [] { return absl::OkStatus(); }}});
    maintenance.RunAt(absl::Now() + absl::Hours(1), [] {});
  }
  EXPECT_LT(absl::Now() - begin, absl::Minutes(1));
}

}  // namespace
}  // namespace poise::engine
