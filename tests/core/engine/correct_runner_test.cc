#include "core/engine/correct_runner.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "core/api/correction_report.h"
#include "core/engine/correct_checkpoint.h"
#include "core/motion/io/clip_file.h"
#include "tests/core/runtime/jobs/attempt_folder.h"

namespace poise::engine {
namespace {

using base::Json;
using testing::AttemptFolder;

constexpr char kArtifact[] = "artifacts/0123";

/// A job that corrects a sample clip of this project.
class CorrectJob : public AttemptFolder {
 public:
  explicit CorrectJob(const Json& more, const std::string& file = "kick.bvh")
      : AttemptFolder(Parameters(more)) {
    input.spec.kind = "correct";
    input.inputs[kArtifact] = std::string(POISE_SAMPLES_DIR) + "/" + file;
  }

  static Json Parameters(const Json& more) {
    Json parameters = {{"sources", {{{"artifact", kArtifact}, {"name", "kick.bvh"}}}},
                       {"variants_per_source", 3},
                       {"effort", "instant"}};
    parameters.update(more);
    return parameters;
  }
};

// Files and report: all that makes a result.
std::map<std::string, std::string> Result(const jobs::RunOutput& output) {
  auto result = AttemptFolder::Contents(output);
  result["report"] = output.report.dump();
  return result;
}

TEST(CorrectRunnerTest, EveryVariantIsAFileInTheFormOfItsSourceAndAReport) {
  CorrectJob job(Json::object());
  const auto output = job.Run(*MakeCorrectRunner());
  ASSERT_TRUE(output.ok()) << output.status();
  ASSERT_EQ(output->files.size(), 3u);
  const auto source = motion::ReadClipFile(std::string(POISE_SAMPLES_DIR) + "/kick.bvh");
  const auto report = api::CorrectedClipFromJson(output->report["clips"][0]);
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->name, "kick");
  EXPECT_EQ(report->stopped_by, "finished");
  EXPECT_TRUE(report->zero_policy.has_value());
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(output->files[i].name, report->variants[i].file);
    const auto file = motion::ReadClipFile(output->files[i].path);
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_EQ(file->clip.num_frames(), source->clip.num_frames());
    EXPECT_EQ(file->convention.unit_m, source->convention.unit_m);
    EXPECT_EQ(file->convention.channels, source->convention.channels);
    EXPECT_TRUE(report->variants[i].completed);
  }
  EXPECT_EQ(report->variants[2].file, "kick_ik_002.bvh");
  EXPECT_EQ(job.progress.back().step, job.progress.back().total);
}

TEST(CorrectRunnerTest, AnAttemptThatGoesOnEndsWithTheSameBytes) {
  const Json fast = {{"effort", "fast"}, {"overrides", {{"learning.rollouts", 3}}}};
  CorrectJob calm(fast);
  const auto undisturbed = calm.Run(*MakeCorrectRunner());
  ASSERT_TRUE(undisturbed.ok()) << undisturbed.status();
  EXPECT_FALSE(calm.checkpoint_steps.empty());
  for (const int64_t stop_at : {2, 5, 8}) {
    CorrectJob rough(fast);
    rough.on_progress = [&](const base::Progress& progress) {
      if (progress.step >= stop_at) rough.context.run.cancellation.Cancel();
    };
    const auto stopped = rough.Run(*MakeCorrectRunner());
    ASSERT_TRUE(absl::IsCancelled(stopped.status())) << stopped.status();
    rough.context.run.cancellation = base::CancellationToken();
    rough.on_progress = nullptr;
    rough.progress.clear();
    const int64_t kept_step = rough.input.checkpoint_step;
    const auto resumed = rough.Run(*MakeCorrectRunner());
    ASSERT_TRUE(resumed.ok()) << resumed.status();
    EXPECT_EQ(rough.progress.front().step, kept_step);
    EXPECT_EQ(Result(*resumed), Result(*undisturbed)) << "stopped at step " << stop_at;
  }
}

TEST(CorrectRunnerTest, ACheckpointOfSomethingElseIsRefused) {
  for (const std::string& bytes :
       {std::string(), std::string("{}"), std::string("\xa1\x00", 2), std::string(100, '\xff')}) {
    CorrectJob job(Json::object());
    job.input.checkpoint = bytes;
    EXPECT_EQ(base::ErrorReason(job.Run(*MakeCorrectRunner()).status()), "CORRUPT_CHECKPOINT");
  }
}

TEST(CorrectRunnerTest, WhatIsWrongWithASourceIsNamed) {
  CorrectJob missing(Json::object());
  missing.input.inputs.clear();
  EXPECT_EQ(base::ErrorReason(missing.Run(*MakeCorrectRunner()).status()), "INPUT_NOT_FOUND");
  CorrectJob text(Json::object(), "README.md");
  const Status status = text.Run(*MakeCorrectRunner()).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
  EXPECT_EQ(base::ErrorField(status).substr(0, 10), "sources[0]");
}

TEST(CorrectRunnerTest, ParametersAreCheckedBeforeAnyWork) {
  const Json good = CorrectJob::Parameters(Json::object());
  EXPECT_TRUE(ValidateCorrect(good).ok());
  const auto field = [&](const Json& more) {
    Json parameters = good;
    parameters.update(more);
    return base::ErrorField(ValidateCorrect(parameters));
  };
  EXPECT_EQ(field({{"efort", "fast"}}), "spec.parameters.efort");
  EXPECT_EQ(field({{"overrides", {{"world.rate", 600}}}}), "spec.parameters.world.rate");
  EXPECT_EQ(field({{"method", "magic"}}), "spec.parameters.method");
  EXPECT_EQ(base::ErrorField(ValidateCorrect(Json::object())), "spec.parameters.sources");
}

}  // namespace
}  // namespace poise::engine
