#include "client/cli/console.h"

#include <gtest/gtest.h>

namespace poise::cli {
namespace {

TEST(ConsoleTest, EveryKindOfErrorHasItsExitCode) {
  const std::pair<absl::StatusCode, int> expected[] = {
      {absl::StatusCode::kInternal, 1},           {absl::StatusCode::kUnknown, 1},
      {absl::StatusCode::kInvalidArgument, 2},    {absl::StatusCode::kNotFound, 3},
      {absl::StatusCode::kFailedPrecondition, 4}, {absl::StatusCode::kUnauthenticated, 4},
      {absl::StatusCode::kUnavailable, 5},        {absl::StatusCode::kCancelled, 6},
      {absl::StatusCode::kDeadlineExceeded, 6},   {absl::StatusCode::kResourceExhausted, 7}};
  for (const auto& [code, exit_code] : expected) {
    EXPECT_EQ(static_cast<int>(ExitCodeOf(Status(code, ""))), exit_code);
  }
  EXPECT_EQ(ExitCodeOf(absl::OkStatus()), ExitCode::kOk);
}

TEST(ConsoleTest, AJsonErrorHasCodeReasonMessageAndField) {
  const Console console(/*json=*/true);
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(console.Finish(base::NotFound("FILE_NOT_FOUND", "in", "a.bvh: no such file")),
            ExitCode::kNotFound);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(),
            R"({"error":{"code":"NOT_FOUND","reason":"FILE_NOT_FOUND",)"
            R"("message":"a.bvh: no such file","field":"in"}})"
            "\n");
}

TEST(ConsoleTest, BytesThatAreNotUtf8DoNotBreakTheJson) {
  const Console console(/*json=*/true);
  ::testing::internal::CaptureStdout();
  console.PrintJson({{"joint", "M\xFCller"}});
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "{\"joint\":\"M\uFFFDller\"}\n");
}

}  // namespace
}  // namespace poise::cli
