// The poise program as a user meets it: help, wrong usage, no server.
#include <gmock/gmock.h>

#include "absl/time/clock.h"
#include "core/base/version.h"
#include "tests/client/cli/poise_program.h"
#include "tests/support/process.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace poise::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(UsageTest, TheVersionIsThatOfTheBuild) {
  const PoiseRun run = RunPoise({"--version"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.out, std::string("poise ") + base::Version() + "\n");
}

TEST(UsageTest, EveryCommandExplainsItselfWithExamples) {
  EXPECT_EQ(RunPoise({"--help"}).exit_code, 0);
  for (const char* command : {"info", "convert", "fk", "augment", "correct", "health"}) {
    const PoiseRun run = RunPoise({command, "--help"});
    EXPECT_EQ(run.exit_code, 0) << command;
    EXPECT_THAT(run.out, HasSubstr(std::string("  poise ") + command)) << command;
    EXPECT_THAT(run.out, HasSubstr("--json")) << command;
  }
  for (const std::string command :
       {"create", "list", "get", "watch", "cancel", "result", "delete", "retry"}) {
    const PoiseRun run = RunPoise({"jobs", command, "--help"});
    EXPECT_EQ(run.exit_code, 0) << command;
    EXPECT_THAT(run.out, HasSubstr("  poise jobs " + command)) << command;
    EXPECT_THAT(run.out, HasSubstr("--json")) << command;
  }
  EXPECT_THAT(RunPoise({"admin", "doctor", "--help"}).out, HasSubstr("poise admin doctor"));
}

TEST(UsageTest, WrongUsageExitsWithTwoAndASuggestion) {
  const PoiseRun command = RunPoise({"agument", "kick.bvh"});
  EXPECT_EQ(command.exit_code, 2);
  EXPECT_THAT(command.err, HasSubstr("'augment'"));
  const PoiseRun flag = RunPoise({"augment", "kick.bvh", "--sed", "1", "--json"});
  EXPECT_EQ(flag.exit_code, 2);
  EXPECT_EQ(flag.Error().at("reason"), "UNKNOWN_FLAG");
  EXPECT_EQ(flag.Error().at("field"), "--sed");
}

TEST(UsageTest, HealthWithoutAServerExitsWithFive) {
  const PoiseRun run = RunPoise({"health", "--json"});
  EXPECT_EQ(run.exit_code, 5);
  EXPECT_EQ(run.Error().at("reason"), "NO_SERVER");
}

TEST(UsageTest, AFlagGivenTwiceTakesTheLastValue) {
  const PoiseRun run = RunPoise({"fk", "a.bvh", "--frames=x", "--frames=y", "--json"});
  EXPECT_EQ(run.exit_code, 3) << "the flags are fine, the file is not there";
}

TEST(UsageTest, HelpComesFast) {
  if (testing::kInstrumented) GTEST_SKIP() << "an instrumented program is slow";
  double best = 1;
  for (int attempt = 0; attempt < 10; ++attempt) {
    const absl::Time start = absl::Now();
    RunPoise({"--help"});
    best = std::min(best, absl::ToDoubleSeconds(absl::Now() - start));
  }
  EXPECT_LT(best, 0.1) << "with the poll of the test and without a quiet machine";
}

TEST(UsageTest, TheProgramLinksNeitherLibTorchNorBullet) {
  Process ldd({"/usr/bin/ldd", ProgramPath("poise")});
  ASSERT_EQ(ldd.Wait(), 0);
  EXPECT_THAT(ldd.Output(), HasSubstr("libgrpc"));
  EXPECT_THAT(ldd.Output(), Not(HasSubstr("torch")));
  EXPECT_THAT(ldd.Output(), Not(HasSubstr("Bullet")));
}

}  // namespace
}  // namespace poise::testing
