#include "core/runtime/jobs/selftest_runner.h"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>

#include "tests/core/runtime/jobs/attempt_folder.h"

namespace poise::jobs {
namespace {

using testing::AttemptFolder;

base::Json Quick(base::Json more = base::Json::object()) {
  base::Json parameters = {
      {"steps", 20}, {"step_ms", 0}, {"artifacts", 2}, {"artifact_bytes", 100}};
  parameters.update(more);
  return parameters;
}

TEST(SelftestRunnerTest, EveryStepIsReportedAndTheFilesHaveTheirSize) {
  SelftestRunner runner;
  AttemptFolder job(Quick());
  const StatusOr<RunOutput> output = job.Run(runner);
  ASSERT_TRUE(output.ok()) << output.status();
  ASSERT_EQ(job.progress.size(), 21u);
  EXPECT_EQ(job.progress.front().step, 0);
  EXPECT_EQ(job.progress.back().step, 20);
  EXPECT_EQ(job.progress.back().total, 20);
  const auto files = AttemptFolder::Contents(*output);
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files.at("output/0000.bin").size(), 100u);
  EXPECT_NE(files.at("output/0000.bin"), files.at("output/0001.bin"));
}

TEST(SelftestRunnerTest, FilesComeFromTheSeedAlone) {
  SelftestRunner runner;
  AttemptFolder one(Quick()), same(Quick()), other(Quick(), 8);
  const auto files = AttemptFolder::Contents(*one.Run(runner));
  EXPECT_EQ(files, AttemptFolder::Contents(*same.Run(runner)));
  EXPECT_NE(files, AttemptFolder::Contents(*other.Run(runner)));
}

TEST(SelftestRunnerTest, ResumedAnywhereItMakesTheSameFiles) {
  SelftestRunner runner;
  AttemptFolder undisturbed(Quick());
  const auto files = AttemptFolder::Contents(*undisturbed.Run(runner));
  for (const int step : {1, 7, 13, 19}) {
    AttemptFolder job(Quick({{"checkpoint_every", 3}, {"fail_at", step}, {"fail_attempts", 1}}));
    EXPECT_EQ(base::ErrorReason(job.Run(runner).status()), "SELFTEST_UNAVAILABLE");
    EXPECT_EQ(job.input.checkpoint_step, (step - 1) / 3 * 3);
    EXPECT_EQ(AttemptFolder::Contents(*job.Run(runner)), files) << "failed at step " << step;
  }
}

TEST(SelftestRunnerTest, AskedToStopItSavesWhereItIsOrCarriesOn) {
  SelftestRunner runner;
  AttemptFolder obeys(Quick());
  obeys.on_progress = [&](const base::Progress& value) {
    if (value.step == 11) obeys.context.run.cancellation.Cancel();
  };
  EXPECT_EQ(obeys.Run(runner).status().code(), absl::StatusCode::kCancelled);
  EXPECT_EQ(obeys.checkpoint_steps, std::vector<int64_t>{11});
  AttemptFolder ignores(Quick({{"on_stop", "ignore"}}));
  ignores.context.run.cancellation.Cancel();
  EXPECT_TRUE(ignores.Run(runner).ok());
}

TEST(SelftestRunnerTest, ItFailsAsAskedWithTheCodesThatDecideAboutRetries) {
  SelftestRunner runner;
  const auto run = [&](const char* failure) {
    AttemptFolder job(Quick({{"fail_at", 5}, {"failure", failure}}));
    return job.Run(runner).status();
  };
  EXPECT_EQ(run("unavailable").code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(run("invalid").code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(run("diverge").code(), absl::StatusCode::kOutOfRange);
  EXPECT_EQ(base::ErrorReason(run("diverge")), "DIVERGED");
  EXPECT_THROW(run("throw").IgnoreError(), std::runtime_error);
  EXPECT_THROW(run("out_of_memory").IgnoreError(), std::bad_alloc);
  EXPECT_DEATH(run("crash").IgnoreError(), "");
  EXPECT_DEATH(run("segfault").IgnoreError(), "");
  EXPECT_EXIT(run("exit").IgnoreError(), ::testing::ExitedWithCode(3), "");
}

TEST(SelftestRunnerTest, StrangeCheckpointIsRefused) {
  SelftestRunner runner;
  for (const char* bytes : {"", "{}", "[1]", R"({"step":"1","digest":"a"})", "\x01\xff"}) {
    AttemptFolder job(Quick());
    job.input.checkpoint = bytes;
    EXPECT_EQ(base::ErrorReason(job.Run(runner).status()), "CORRUPT_CHECKPOINT") << bytes;
  }
}

}  // namespace
}  // namespace poise::jobs
