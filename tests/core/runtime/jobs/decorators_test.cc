#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "absl/time/clock.h"
#include "core/base/sha256.h"
#include "core/base/telemetry.h"
#include "core/base/version.h"
#include "core/runtime/jobs/counting_runner.h"
#include "core/runtime/jobs/deadline_runner.h"
#include "core/runtime/jobs/log_runner.h"
#include "core/runtime/jobs/manifest_runner.h"
#include "core/runtime/jobs/selftest_runner.h"
#include "tests/core/runtime/jobs/attempt_folder.h"

namespace poise::jobs {
namespace {

using testing::AttemptFolder;

// Runs a function.
class Stand : public JobRunner {
 public:
  using Body = std::function<StatusOr<RunOutput>(const RunInput&, const JobContext&)>;
  explicit Stand(Body body) : body_(std::move(body)) {}
  StatusOr<RunOutput> Run(const RunInput& input, const JobContext& context) override {
    return body_(input, context);
  }

 private:
  const Body body_;
};

std::unique_ptr<JobRunner> Returning(StatusOr<RunOutput> output) {
  return std::make_unique<Stand>([output](const auto&, const auto&) { return output; });
}

OutputFile Write(const RunInput& input, const std::string& name, const std::string& bytes) {
  const auto path = input.folder / base::Sha256Hex(name);
  std::ofstream(path, std::ios::binary) << bytes;
  return {.name = name, .path = path};
}

TEST(LogRunnerTest, OneLineAtTheStartAndOneAtTheEnd) {
  std::vector<std::pair<std::string, base::Json>> lines;
  const LogFunction log = [&](std::string_view event, const base::Json& fields) {
    lines.emplace_back(event, fields);
  };
  AttemptFolder job(base::Json::object());
  LogRunner good(Returning(RunOutput()), log);
  ASSERT_TRUE(job.Run(good).ok());
  LogRunner bad(Returning(base::InvalidArgument("TOO_BLUE", "spec.parameters.hue", "no")), log);
  EXPECT_EQ(base::ErrorReason(job.Run(bad).status()), "TOO_BLUE");
  ASSERT_EQ(lines.size(), 4u);
  for (const auto& [event, fields] : lines) {
    EXPECT_EQ(fields["job"], job.input.job);
    EXPECT_EQ(fields["kind"], "selftest");
    EXPECT_EQ(fields["trace_id"], "trace-1");
  }
  EXPECT_EQ(lines[0].first, "attempt_start");
  EXPECT_EQ(lines[0].second["attempt"], 1);
  EXPECT_EQ(lines[1].first, "attempt_end");
  EXPECT_EQ(lines[1].second["code"], "OK");
  EXPECT_GE(lines[1].second["seconds"], 0.0);
  EXPECT_EQ(lines[3].second["attempt"], 2);
  EXPECT_EQ(lines[3].second["code"], "INVALID_ARGUMENT");
  EXPECT_EQ(lines[3].second["reason"], "TOO_BLUE");
}

// Adds up what is counted.
class Counts : public base::Telemetry {
 public:
  struct Sum : base::Counter, base::Gauge, base::Histogram {
    void Increment(double by) override { value += by; }
    void Add(double by) override { value += by, greatest = std::max(greatest, value); }
    void Observe(double) override { ++value; }
    double value = 0, greatest = 0;
  };
  base::Counter& counter(const std::string& n, const std::string&, const base::Labels& l) override {
    return sums[n + "/" + l.at("kind") + "/" + l.at("code") + "/" + l.at("reason")];
  }
  base::Gauge& gauge(const std::string& n, const std::string&, const base::Labels&) override {
    return sums[n];
  }
  base::Histogram& histogram(const std::string& n, const std::string&,
                             const base::Labels& l) override {
    return sums[n + "/" + l.at("kind")];
  }
  std::map<std::string, Sum> sums;
};

TEST(CountingRunnerTest, EveryAttemptIsCountedOnceByItsEnd) {
  Counts counts;
  AttemptFolder job(base::Json::object());
  CountingRunner good(Returning(RunOutput()), counts);
  CountingRunner bad(Returning(base::Internal("BROKEN", "no")), counts);
  job.Run(good).IgnoreError();
  job.Run(bad).IgnoreError();
  job.Run(good).IgnoreError();
  EXPECT_EQ(counts.sums["poise_worker_attempts_total/selftest/OK/OK"].value, 2);
  EXPECT_EQ(counts.sums["poise_worker_attempts_total/selftest/INTERNAL/BROKEN"].value, 1);
  EXPECT_EQ(counts.sums["poise_worker_attempt_seconds/selftest"].value, 3);
  EXPECT_EQ(counts.sums["poise_worker_attempts_running"].value, 0);
  EXPECT_EQ(counts.sums["poise_worker_attempts_running"].greatest, 1);
}

TEST(DeadlineRunnerTest, WorkPastTheDeadlineIsToldToStopAndHasFailed) {
  AttemptFolder job({{"steps", 1'000'000}, {"step_ms", 1}});
  DeadlineRunner runner(MakeSelftestRunner(), absl::Milliseconds(100));
  const Status status = job.Run(runner).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kDeadlineExceeded);
  EXPECT_EQ(base::ErrorField(status), "limits.deadline");
  EXPECT_EQ(job.checkpoint_steps.size(), 1u);
}

TEST(DeadlineRunnerTest, SuccessAndEarlierEndsStand) {
  const auto late = [](StatusOr<RunOutput> output) {
    return std::make_unique<Stand>([output](const auto&, const auto& context) {
      while (context.run.Check().ok()) absl::SleepFor(absl::Milliseconds(1));
      return output;
    });
  };
  AttemptFolder job(base::Json::object());
  DeadlineRunner success(late(RunOutput()), absl::Milliseconds(10));
  EXPECT_TRUE(job.Run(success).ok());
  DeadlineRunner vanished(late(base::MakeError(absl::StatusCode::kUnavailable, "PROCESS_LOST", "",
                                               "killed after its grace")),
                          absl::Milliseconds(10));
  EXPECT_EQ(job.Run(vanished).status().code(), absl::StatusCode::kDeadlineExceeded);
  DeadlineRunner early(Returning(base::Internal("BROKEN", "no")), absl::Hours(1));
  EXPECT_EQ(base::ErrorReason(job.Run(early).status()), "BROKEN");
  DeadlineRunner none(Returning(base::Internal("BROKEN", "no")), absl::InfiniteDuration());
  EXPECT_EQ(base::ErrorReason(job.Run(none).status()), "BROKEN");
  job.context.run.cancellation.Cancel();
  DeadlineRunner asked(late(absl::CancelledError("")), absl::ZeroDuration());
  EXPECT_EQ(job.Run(asked).status().code(), absl::StatusCode::kCancelled);
}

std::string Manifest(const RunOutput& output) {
  return AttemptFolder::Contents(output).at(kManifestName);
}

TEST(ManifestRunnerTest, SaysWhereAResultComesFromAndWhatBelongsToIt) {
  AttemptFolder job(base::Json{{"steps", 3}});
  ManifestRunner runner(std::make_unique<Stand>([](const RunInput& input, const auto&) {
    RunOutput output;
    output.files = {Write(input, "b/two.txt", "22"), Write(input, "a.txt", "abc")};
    output.report = {{"score", 0.1 + 0.2}};
    return output;
  }));
  const RunOutput output = *job.Run(runner);
  ASSERT_EQ(output.files.size(), 3u);
  EXPECT_EQ(output.files.back().media_type, "application/json");
  const base::Json manifest = base::Json::parse(Manifest(output));
  EXPECT_EQ(manifest["kind"], "selftest");
  EXPECT_EQ(manifest["parameters"], job.input.spec.parameters);
  EXPECT_EQ(manifest["seed"], 7);
  EXPECT_EQ(manifest["version"], base::Version());
  EXPECT_EQ(manifest["input_sha256"].get<std::string>().size(), 64u);
  ASSERT_EQ(manifest["files"].size(), 2u);
  EXPECT_EQ(manifest["files"][0]["name"], "a.txt");
  EXPECT_EQ(manifest["files"][0]["size_bytes"], 3);
  EXPECT_EQ(manifest["files"][0]["sha256"], base::Sha256Hex("abc"));
  EXPECT_EQ(manifest["files"][1]["name"], "b/two.txt");
  EXPECT_EQ(manifest["report"]["score"], 0.1 + 0.2);
}

TEST(ManifestRunnerTest, IsTheSameForAJobThatWasInterrupted) {
  AttemptFolder undisturbed({{"steps", 20}, {"step_ms", 0}, {"artifacts", 5}});
  ManifestRunner runner(MakeSelftestRunner());
  const auto files = AttemptFolder::Contents(*undisturbed.Run(runner));
  AttemptFolder job({{"steps", 20}, {"step_ms", 0}, {"artifacts", 5}});
  job.on_progress = [&](const base::Progress& value) {
    if (value.step == 9) job.context.run.cancellation.Cancel();
  };
  EXPECT_FALSE(job.Run(runner).ok());
  job.on_progress = nullptr;
  job.context.run.cancellation = base::CancellationToken();
  EXPECT_EQ(AttemptFolder::Contents(*job.Run(runner)), files);
}

TEST(ManifestRunnerTest, HashTellsInputsApartButNotTheOrderOfTheirNames) {
  const auto hash = [](const char* parameters, uint64_t seed) {
    AttemptFolder job(base::Json::parse(parameters), seed);
    ManifestRunner runner(Returning(RunOutput()));
    return base::Json::parse(Manifest(*job.Run(runner)))["input_sha256"].get<std::string>();
  };
  EXPECT_EQ(hash(R"({"a":1,"b":2})", 1), hash(R"({"b":2,"a":1})", 1));
  EXPECT_NE(hash(R"({"a":1})", 1), hash(R"({"a":2})", 1));
  EXPECT_NE(hash(R"({"a":1})", 1), hash(R"({"a":1})", 2));
}

TEST(ManifestRunnerTest, ResultThatIsNoneIsRefused) {
  const auto run = [](std::vector<std::string> names) {
    AttemptFolder job(base::Json::object());
    ManifestRunner runner(std::make_unique<Stand>([&](const RunInput& input, const auto&) {
      RunOutput output;
      for (const std::string& name : names) output.files.push_back(Write(input, name, "x"));
      return output;
    }));
    return base::ErrorReason(job.Run(runner).status());
  };
  EXPECT_EQ(run({"a", "a"}), "BAD_OUTPUT");
  EXPECT_EQ(run({"manifest.json"}), "BAD_OUTPUT");
  for (const char* name : {"", "/etc/passwd", "../a", "a/../../b", "a/", "./a", ".."}) {
    EXPECT_EQ(run({name}), "BAD_OUTPUT") << name;
  }
  AttemptFolder job(base::Json::object());
  RunOutput missing;
  missing.files = {{.name = "a", .path = "/nowhere/a"}};
  ManifestRunner runner(Returning(missing));
  EXPECT_EQ(base::ErrorReason(job.Run(runner).status()), "BAD_OUTPUT");
}

}  // namespace
}  // namespace poise::jobs
