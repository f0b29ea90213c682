#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>
#include <thread>

#include "absl/time/clock.h"
#include "server/worker/attempt.h"
#include "server/worker/child_environment.h"
#include "server/worker/drain_signal.h"
#include "server/worker/persistence.h"
#include "server/worker/work_folder.h"
#include "tests/support/temporary_folder.h"

namespace poise::worker {
namespace {

Status Unavailable() {
  return base::MakeError(absl::StatusCode::kUnavailable, "NO_SERVER", "", "nobody there");
}

TEST(PersistenceTest, CallIsRepeatedUntilItsAnswerIsDefinite) {
  int calls = 0;
  const Status status =
      Persist([&] { return ++calls < 3 ? Unavailable() : base::InvalidArgument("BAD", "", ""); },
              [] { return false; });
  EXPECT_EQ(base::ErrorReason(status), "BAD");
  EXPECT_EQ(calls, 3);
}

TEST(PersistenceTest, GivingUpEndsItAfterOneMoreTry) {
  int calls = 0;
  const StatusOr<int> answer = Persist(
      [&]() -> StatusOr<int> {
        ++calls;
        return Unavailable();
      },
      [] { return true; });
  EXPECT_FALSE(answer.ok());
  EXPECT_EQ(calls, 1);
}

TEST(PersistenceTest, PausesGrowToTheirLimitAndDiffer) {
  Pauses pauses({.first_pause = absl::Seconds(1), .longest_pause = absl::Seconds(3)});
  for (const double longest : {1.0, 2.0, 3.0, 3.0}) {
    const double pause = absl::ToDoubleSeconds(pauses.Next());
    EXPECT_GE(pause, longest / 2);
    EXPECT_LE(pause, longest);
  }
  pauses.Reset();
  EXPECT_LE(pauses.Next(), absl::Seconds(1));
}

TEST(DrainSignalTest, ListenersHearOfTheFirstStageOnceAndStagesGoForward) {
  DrainSignal signal;
  int early = 0, late = 0, gone = 0;
  const DrainSignal::Listener listener(signal, [&] { ++early; });
  {
    const DrainSignal::Listener leaves(signal, [&] { ++gone; });
  }
  EXPECT_FALSE(signal.WaitFor(absl::ZeroDuration()));
  signal.Advance(DrainStage::kHurry);
  signal.Advance(DrainStage::kDrain);
  const DrainSignal::Listener comes(signal, [&] { ++late; });
  EXPECT_TRUE(signal.WaitFor(absl::Hours(1)));
  EXPECT_EQ(signal.stage(), DrainStage::kHurry);
  EXPECT_EQ(early, 1);
  EXPECT_EQ(late, 1);
  EXPECT_EQ(gone, 0);
}

TEST(WorkFolderTest, FolderInUseIsLeftAloneAndAnAbandonedOneIsRemoved) {
  testing::TemporaryFolder parent;
  const auto used = *WorkFolder::Create(parent.path(), "used");
  std::ofstream(used->path() / "file") << "x";
  const auto abandoned = parent.path() / "abandoned";
  std::filesystem::create_directory(abandoned);
  std::ofstream(abandoned.string() + ".lock") << "";
  std::filesystem::create_directory(parent.path() / "of others");
  {
    const auto next = *WorkFolder::Create(parent.path(), "next");
    EXPECT_TRUE(std::filesystem::exists(used->path() / "file"));
    EXPECT_FALSE(std::filesystem::exists(abandoned));
    EXPECT_TRUE(std::filesystem::exists(parent.path() / "of others"));
    EXPECT_EQ(base::ErrorReason(WorkFolder::Create(parent.path(), "next").status()),
              "BAD_WORK_DIR");
  }
  EXPECT_FALSE(std::filesystem::exists(parent.path() / "next"));
  EXPECT_FALSE(std::filesystem::exists(parent.path() / "next.lock"));
}

TEST(ChildEnvironmentTest, ChildGetsNoTokenAndOneThread) {
  using ::testing::Contains;
  using ::testing::Not;
  setenv("POISE_TOKEN", "secret", 1);
  setenv("POISE_SOMETHING", "else", 1);
  unsetenv("OMP_NUM_THREADS");
  EXPECT_THAT(ChildEnvironment(), Not(Contains("POISE_TOKEN=secret")));
  EXPECT_THAT(ChildEnvironment(), Contains("POISE_SOMETHING=else"));
  EXPECT_THAT(ChildEnvironment(), Contains("OMP_NUM_THREADS=1"));
  setenv("OMP_NUM_THREADS", "3", 1);
  EXPECT_THAT(ChildEnvironment(), Contains("OMP_NUM_THREADS=3"));
  EXPECT_THAT(ChildEnvironment(), Not(Contains("OMP_NUM_THREADS=1")));
  unsetenv("OMP_NUM_THREADS");
  unsetenv("POISE_TOKEN");
}

TEST(FailureOutcomeTest, ReasonSaysWhichBudgetAnEndCosts) {
  const auto outcome = [](absl::StatusCode code, const char* reason) {
    return FailureOutcome(base::MakeError(code, reason, "", ""), {}).outcome;
  };
  EXPECT_EQ(outcome(absl::StatusCode::kUnavailable, "STALLED"), api::AttemptOutcome::kStalled);
  EXPECT_EQ(outcome(absl::StatusCode::kUnavailable, "PROCESS_LOST"), api::AttemptOutcome::kLost);
  EXPECT_EQ(outcome(absl::StatusCode::kUnavailable, "CANNOT_START"), api::AttemptOutcome::kError);
  EXPECT_EQ(outcome(absl::StatusCode::kCancelled, "CANCELLED"), api::AttemptOutcome::kCancelled);
  EXPECT_EQ(outcome(absl::StatusCode::kInternal, "BAD_OUTPUT"), api::AttemptOutcome::kError);
}

}  // namespace
}  // namespace poise::worker
