#include "core/base/run_context.h"

#include <gtest/gtest.h>

#include "absl/time/clock.h"

namespace poise::base {
namespace {

TEST(RunContextTest, CopiesShareTheWishToStop) {
  RunContext context;
  const RunContext copy = context;
  EXPECT_TRUE(copy.Check().ok());
  context.cancellation.Cancel();
  EXPECT_EQ(copy.Check().code(), absl::StatusCode::kCancelled);
}

TEST(RunContextTest, APassedDeadlineIsAnError) {
  RunContext context;
  context.deadline = absl::Now() - absl::Seconds(1);
  EXPECT_EQ(ErrorReason(context.Check()), "DEADLINE_EXCEEDED");
  context.deadline = absl::Now() + absl::Hours(1);
  EXPECT_TRUE(context.Check().ok());
}

}  // namespace
}  // namespace poise::base
