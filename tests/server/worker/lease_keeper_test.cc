#include "server/worker/lease_keeper.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/time/clock.h"
#include "tests/server/worker/fake_server.h"

namespace poise::worker {
namespace {

using testing::FakeServer;

bool Eventually(const std::function<bool()>& condition) {
  for (const absl::Time end = absl::Now() + absl::Seconds(20); absl::Now() < end;) {
    if (condition()) return true;
    absl::SleepFor(absl::Milliseconds(5));
  }
  return false;
}

class LeaseKeeperTest : public ::testing::Test {
 protected:
  void Start(absl::Duration expires_in = absl::Seconds(30)) {
    keeper_ =
        std::make_unique<LeaseKeeper>(config_, server_.client(), server_.lease(expires_in), stop_);
  }

  FakeServer server_;
  LeaseKeeperConfig config_{.heartbeat_interval = absl::Seconds(60)};
  base::CancellationToken stop_;
  std::unique_ptr<LeaseKeeper> keeper_;
};

TEST_F(LeaseKeeperTest, WishToCancelArrivesThroughAHeldCall) {
  Start();
  ASSERT_TRUE(Eventually([&] { return server_.held() == 1; }));
  EXPECT_FALSE(stop_.cancelled());
  server_.Cancel();
  const absl::Time asked = absl::Now();
  ASSERT_TRUE(Eventually([&] { return stop_.cancelled(); }));
  EXPECT_LT(absl::Now() - asked, absl::Seconds(5));  // the hold is a minute
  EXPECT_EQ(keeper_->verdict(), Verdict::kCancel);
  server_.LoseLease();
  EXPECT_TRUE(Eventually([&] { return keeper_->lost(); }));
}

TEST_F(LeaseKeeperTest, LostLeaseIsNoticedAndStaysLost) {
  Start();
  server_.LoseLease();
  ASSERT_TRUE(Eventually([&] { return keeper_->lost(); }));
  EXPECT_TRUE(stop_.cancelled());
  server_.Cancel();
  absl::SleepFor(absl::Milliseconds(50));
  EXPECT_TRUE(keeper_->lost());
}

TEST_F(LeaseKeeperTest, SilenceForAsLongAsTheLeaseLastsLosesIt) {
  server_.FallSilent();
  const absl::Time start = absl::Now();
  Start(absl::Milliseconds(700));
  keeper_->Report({.step = 1, .total = 0, .message = ""});
  ASSERT_TRUE(Eventually([&] { return keeper_->lost(); }));
  EXPECT_GE(absl::Now() - start, absl::Milliseconds(700));
  EXPECT_LT(absl::Now() - start, absl::Seconds(5));
}

TEST_F(LeaseKeeperTest, FirstAndLastProgressAreNotHeldBack) {
  config_.progress_interval = absl::Seconds(60);
  Start();
  keeper_->Report({.step = 1, .total = 9, .message = ""});
  ASSERT_TRUE(Eventually([&] { return server_.steps() == std::vector<int64_t>{1}; }));
  for (int64_t step = 2; step <= 9; ++step) {
    keeper_->Report({.step = step, .total = 9, .message = ""});
  }
  absl::SleepFor(absl::Milliseconds(100));
  EXPECT_EQ(server_.steps(), std::vector<int64_t>{1});
  keeper_->FlushProgress(absl::Seconds(10));
  EXPECT_EQ(server_.steps(), (std::vector<int64_t>{1, 9}));
  keeper_->FlushProgress(absl::Seconds(10));
  EXPECT_EQ(server_.steps().size(), 2u);
}

TEST_F(LeaseKeeperTest, OtherCallsTellOfALostLeaseToo) {
  Start();
  keeper_->Learn(base::MakeError(absl::StatusCode::kUnavailable, "NO_SERVER", "", ""));
  EXPECT_FALSE(keeper_->lost());
  keeper_->Learn(base::MakeError(absl::StatusCode::kAborted, "LEASE_LOST", "", ""));
  EXPECT_TRUE(keeper_->lost());
}

TEST_F(LeaseKeeperTest, EndsAtOnceThoughCallsAreUnderWay) {
  server_.FallSilent();
  Start();
  keeper_->Report({.step = 1, .total = 0, .message = ""});
  ASSERT_TRUE(Eventually([&] { return server_.held() == 1; }));
  const absl::Time asked = absl::Now();
  keeper_.reset();
  EXPECT_LT(absl::Now() - asked, absl::Seconds(5));
}

}  // namespace
}  // namespace poise::worker
