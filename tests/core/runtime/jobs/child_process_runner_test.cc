#include "core/runtime/jobs/child_process_runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "absl/time/clock.h"
#include "core/runtime/jobs/selftest_runner.h"
#include "tests/core/runtime/jobs/attempt_folder.h"
#include "tests/support/process.h"

namespace poise::jobs {
namespace {

using testing::AttemptFolder;
using ::testing::Contains;
using ::testing::HasSubstr;

ChildProcessConfig Config() {
  ChildProcessConfig config;
  config.program = POISE_CHILD_PROGRAM;
  config.arguments = {"child_program", "--child"};
  config.stall_timeout = absl::Seconds(60);
  return config;
}

base::Json Selftest(base::Json more = base::Json::object()) {
  base::Json parameters = {{"steps", 20}, {"step_ms", 1}, {"artifacts", 2}};
  parameters.update(more);
  return parameters;
}

// Processes that have `text` in their command line.
std::set<pid_t> ProcessesWith(const std::string& text) {
  std::set<pid_t> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream file(entry.path() / "cmdline", std::ios::binary);
    const std::string words(std::istreambuf_iterator<char>(file), {});
    if (words.find(text) != std::string::npos) found.insert(std::stoi(name));
  }
  return found;
}

bool GoneWithin(const std::string& text, absl::Duration limit) {
  for (const absl::Time end = absl::Now() + limit; absl::Now() < end;) {
    if (ProcessesWith(text).empty()) return true;
    absl::SleepFor(absl::Milliseconds(10));
  }
  return false;
}

// Runs once in a child with a name of its own; afterwards no such process is left.
StatusOr<RunOutput> RunIn(AttemptFolder& job, ChildProcessConfig config, const std::string& name) {
  config.arguments = {name, "--child"};
  ChildProcessRunner runner(config);
  StatusOr<RunOutput> output = job.Run(runner);
  EXPECT_TRUE(GoneWithin(name, absl::Seconds(5))) << name;
  return output;
}

TEST(ChildProcessRunnerTest, ResultIsThatOfTheSameProcess) {
  SelftestRunner direct;
  AttemptFolder here(Selftest()), there(Selftest());
  ChildProcessRunner child(Config());
  const StatusOr<RunOutput> output = there.Run(child);
  ASSERT_TRUE(output.ok()) << output.status();
  EXPECT_EQ(AttemptFolder::Contents(*output), AttemptFolder::Contents(*here.Run(direct)));
  EXPECT_EQ(there.progress.front().step, 0);
  EXPECT_EQ(there.progress.back().step, 20);
  EXPECT_GT(child.usage().peak_memory_bytes, 100'000);
  EXPECT_GT(child.usage().cpu_seconds, 0);
}

TEST(ChildProcessRunnerTest, InputsGetThereAndTheReportComesBack) {
  AttemptFolder job(base::Json::object());
  job.input.spec.kind = "inputs";
  job.input.inputs = {{"artifacts/ab", "/tmp/one"}, {"artifacts/cd", "/tmp/with space"}};
  ChildProcessRunner child(Config());
  const StatusOr<RunOutput> output = job.Run(child);
  ASSERT_TRUE(output.ok()) << output.status();
  EXPECT_EQ(output->report,
            (base::Json{{"artifacts/ab", "/tmp/one"}, {"artifacts/cd", "/tmp/with space"}}));
}

TEST(ChildProcessRunnerTest, UsageIsThatOfTheChild) {
  AttemptFolder busy(Selftest({{"steps", 20}, {"step_ms", 20}, {"busy", true}}));
  ChildProcessRunner child(Config());
  ASSERT_TRUE(busy.Run(child).ok());
  EXPECT_GT(child.usage().cpu_seconds, 0.05);
  AttemptFolder lazy(Selftest({{"steps", 20}, {"step_ms", 20}}));
  ASSERT_TRUE(lazy.Run(child).ok());
  EXPECT_LT(child.usage().cpu_seconds, 0.3);
}

TEST(ChildProcessRunnerTest, EveryFailureComesOutAsWhatItIs) {
  const auto run = [](const char* failure) {
    AttemptFolder job(Selftest({{"fail_at", 5}, {"failure", failure}}));
    return RunIn(job, Config(), std::string("poise-fails-") + failure).status();
  };
  const Status invalid = run("invalid");
  EXPECT_EQ(invalid.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(base::ErrorReason(invalid), "SELFTEST_INVALID");
  EXPECT_EQ(run("unavailable").code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(base::ErrorReason(run("diverge")), "DIVERGED");
  const Status thrown = run("throw");
  EXPECT_EQ(thrown.code(), absl::StatusCode::kInternal);
  EXPECT_EQ(base::ErrorReason(thrown), "UNCAUGHT_EXCEPTION");
  EXPECT_THAT(base::Message(thrown), HasSubstr("as asked for"));
  EXPECT_EQ(base::ErrorReason(run("out_of_memory")), "OUT_OF_MEMORY");
  for (const char* failure : {"crash", "segfault", "exit"}) {
    EXPECT_EQ(base::ErrorReason(run(failure)), "PROCESS_LOST") << failure;
    EXPECT_EQ(run(failure).code(), absl::StatusCode::kUnavailable);
  }
  EXPECT_THAT(base::Message(run("segfault")), HasSubstr("signal 11"));
  EXPECT_THAT(base::Message(run("exit")), HasSubstr("exit code 3"));
}

TEST(ChildProcessRunnerTest, BadParametersNameTheirField) {
  AttemptFolder job(base::Json{{"steps", "many"}});
  ChildProcessRunner child(Config());
  EXPECT_EQ(base::ErrorField(job.Run(child).status()), "spec.parameters.steps");
}

TEST(ChildProcessRunnerTest, ChildWithoutAStepIsKilledAsStalled) {
  for (const bool busy : {false, true}) {
    AttemptFolder job(Selftest({{"fail_at", 5}, {"failure", "hang"}, {"busy", busy}}));
    ChildProcessConfig config = Config();
    config.stall_timeout = absl::Milliseconds(500);
    const Status status = RunIn(job, config, "poise-stalls").status();
    EXPECT_EQ(base::ErrorReason(status), "STALLED");
    EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
    EXPECT_GE(job.progress.back().step, 1);
  }
}

TEST(ChildProcessRunnerTest, SlowSteadyWorkIsNotStalled) {
  AttemptFolder job(Selftest({{"steps", 10}, {"step_ms", 300}}));
  ChildProcessConfig config = Config();
  config.stall_timeout = absl::Seconds(2);
  ChildProcessRunner child(config);
  EXPECT_TRUE(job.Run(child).ok());
}

TEST(ChildProcessRunnerTest, AskedToStopTheChildSavesItsStateAndTheNextOneGoesOn) {
  AttemptFolder job(Selftest({{"steps", 400}, {"step_ms", 5}}));
  job.on_progress = [&](const base::Progress& value) {
    if (value.step >= 10) job.context.run.cancellation.Cancel();
  };
  EXPECT_EQ(RunIn(job, Config(), "poise-obeys").status().code(), absl::StatusCode::kCancelled);
  EXPECT_GE(job.input.checkpoint_step, 10);
  EXPECT_LT(job.input.checkpoint_step, 400);
  job.on_progress = nullptr;
  job.context.run.cancellation = base::CancellationToken();
  ChildProcessRunner child(Config());
  AttemptFolder undisturbed(Selftest({{"steps", 400}, {"step_ms", 0}}));
  EXPECT_EQ(AttemptFolder::Contents(*job.Run(child)),
            AttemptFolder::Contents(*undisturbed.Run(child)));
}

TEST(ChildProcessRunnerTest, ChildThatIgnoresTheWishIsKilledAfterTheGrace) {
  AttemptFolder job(
      Selftest({{"steps", 1'000'000}, {"step_ms", 5}, {"busy", true}, {"on_stop", "ignore"}}));
  absl::Time asked;
  job.on_progress = [&](const base::Progress& value) {
    if (value.step < 10 || job.context.run.cancellation.cancelled()) return;
    asked = absl::Now();
    job.context.run.cancellation.Cancel();
  };
  ChildProcessConfig config = Config();
  config.stop_grace = [] { return absl::Milliseconds(300); };
  EXPECT_EQ(RunIn(job, config, "poise-ignores").status().code(), absl::StatusCode::kCancelled);
  EXPECT_GE(absl::Now() - asked, absl::Milliseconds(300));
  EXPECT_TRUE(job.checkpoint_steps.empty());
}

TEST(ChildProcessRunnerTest, WishBeforeTheStartIsNotLost) {
  AttemptFolder job(Selftest({{"steps", 1'000'000}}));
  job.context.run.cancellation.Cancel();
  ChildProcessConfig config = Config();
  config.stop_grace = [] { return absl::Seconds(60); };  // SIGTERM alone must do
  EXPECT_EQ(RunIn(job, config, "poise-early").status().code(), absl::StatusCode::kCancelled);
  EXPECT_EQ(job.checkpoint_steps.size(), 1u);
}

TEST(ChildProcessRunnerTest, SomebodyElsesSignalIsALossNotACancel) {
  AttemptFolder job(Selftest({{"steps", 1'000'000}}));
  job.on_progress = [&](const base::Progress& value) {
    if (value.step < 3) return;
    for (const pid_t pid : ProcessesWith("poise-shot")) kill(pid, SIGTERM);
  };
  EXPECT_EQ(base::ErrorReason(RunIn(job, Config(), "poise-shot").status()), "PROCESS_LOST");
}

TEST(ChildProcessRunnerTest, KilledAtAnyStepItResumesToTheSameBytes) {
  AttemptFolder undisturbed(Selftest({{"steps", 100}}));
  ChildProcessRunner child(Config());
  const auto files = AttemptFolder::Contents(*undisturbed.Run(child));
  for (const int kill_at : {3, 22, 41, 67, 96}) {
    AttemptFolder job(Selftest({{"steps", 100},
                                {"checkpoint_every", 4},
                                {"fail_at", kill_at},
                                {"failure", "hang"},
                                {"fail_attempts", 1}}));
    job.on_progress = [&](const base::Progress& value) {
      if (value.step < kill_at) return;
      for (const pid_t pid : ProcessesWith("poise-killed")) kill(pid, SIGKILL);
    };
    const Status lost = RunIn(job, Config(), "poise-killed").status();
    EXPECT_EQ(base::ErrorReason(lost), "PROCESS_LOST") << lost;
    job.on_progress = nullptr;
    EXPECT_EQ(AttemptFolder::Contents(*job.Run(child)), files) << "killed at step " << kill_at;
  }
}

TEST(ChildProcessRunnerTest, KilledWhileItWritesACheckpointThePreviousOneCounts) {
  AttemptFolder job(Selftest({{"checkpoint_every", 4}}));
  ChildProcessConfig config = Config();
  config.environment = {"POISE_FAIL_POINTS=child.before_checkpoint_rename=kill:3"};
  EXPECT_EQ(base::ErrorReason(RunIn(job, config, "poise-torn").status()), "PROCESS_LOST");
  EXPECT_EQ(job.checkpoint_steps, (std::vector<int64_t>{4, 8}));
  ChildProcessRunner child(Config());
  AttemptFolder undisturbed(Selftest());
  EXPECT_EQ(AttemptFolder::Contents(*job.Run(child)),
            AttemptFolder::Contents(*undisturbed.Run(child)));
}

TEST(ChildProcessRunnerTest, CheckpointThatCannotBeHandedOverEndsTheAttempt) {
  AttemptFolder job(Selftest({{"steps", 1'000'000}, {"checkpoint_every", 2}}));
  job.context.save_checkpoint = [](std::string_view, int64_t) {
    return base::MakeError(absl::StatusCode::kAborted, "LEASE_LOST", "", "gone");
  };
  EXPECT_EQ(base::ErrorReason(RunIn(job, Config(), "poise-unheard").status()), "LEASE_LOST");
}

TEST(ChildProcessRunnerTest, ChildOwnsNothingOfTheParentAndLeavesNothingBehind) {
  AttemptFolder job(base::Json{{"lines", 5000}});
  job.input.spec.kind = "litter";
  std::vector<std::string> lines;
  ChildProcessConfig config = Config();
  config.max_output_lines = 100;
  config.on_output = [&](std::string_view line) { lines.emplace_back(line); };
  const std::ifstream open_file("/proc/self/cmdline");  // not to be inherited
  const StatusOr<RunOutput> output = RunIn(job, config, "poise-litters");
  ASSERT_TRUE(output.ok()) << output.status();
  EXPECT_EQ(lines.at(0), "descriptors: 0 1 2 3");
  EXPECT_EQ(lines.at(1), "folder: " + job.input.folder.string());
  EXPECT_EQ(lines.at(2).size(), config.max_output_line_bytes);
  ASSERT_EQ(lines.size(), 101u);
  EXPECT_THAT(lines.back(), HasSubstr("more lines"));
}

TEST(ChildProcessRunnerTest, LastWordsOfALostChildAreInItsError) {
  AttemptFolder job(Selftest());
  ChildProcessConfig config = Config();
  config.program = "/bin/sh";
  config.arguments = {"sh", "-c", "echo first; echo cannot go on >&2; exit 9"};
  ChildProcessRunner child(config);
  const std::string message = base::Message(job.Run(child).status());
  EXPECT_THAT(message, HasSubstr("exit code 9"));
  EXPECT_THAT(message, HasSubstr("cannot go on"));
}

TEST(ChildProcessRunnerTest, NonsenseOnTheChannelEndsTheAttempt) {
  for (const char* nonsense : {"hello", "{}", R"({"progress":3})", R"({"result":[{"name":1}]})",
                               R"({"checkpoint":{"file":"/nowhere/at/all","step":1}})"}) {
    AttemptFolder job(Selftest());
    ChildProcessConfig config = Config();
    config.program = "/bin/sh";
    config.arguments = {"sh", "-c", std::string("echo '") + nonsense + "' >&3; sleep 1000"};
    ChildProcessRunner child(config);
    EXPECT_EQ(base::ErrorReason(job.Run(child).status()), "CHILD_PROTOCOL") << nonsense;
  }
}

TEST(ChildProcessRunnerTest, ResultStandsThoughTheProcessDoesNotEnd) {
  AttemptFolder job(Selftest());
  ChildProcessConfig config = Config();
  config.program = "/bin/sh";
  config.arguments = {"sh", "-c",
                      "echo '{\"result\":{\"files\":[],\"report\":null}}' >&3; sleep 1000"};
  config.exit_grace = absl::Milliseconds(200);
  ChildProcessRunner child(config);
  EXPECT_TRUE(job.Run(child).ok());
}

TEST(ChildProcessRunnerTest, ProgramThatIsNotThereIsAnErrorAtOnce) {
  AttemptFolder job(Selftest());
  ChildProcessConfig config = Config();
  config.program = "/nowhere/poise-worker";
  ChildProcessRunner child(config);
  const Status status = job.Run(child).status();
  EXPECT_EQ(base::ErrorReason(status), "CANNOT_START");
  EXPECT_THAT(base::Message(status), HasSubstr("No such file"));
}

TEST(ChildProcessRunnerTest, ChildDiesWithTheProcessThatWatchesIt) {
  testing::TemporaryFolder folder;
  testing::Process supervisor({POISE_CHILD_PROGRAM, "--supervise", folder.path().string()});
  ASSERT_TRUE(supervisor.WaitForOutput("step 3", absl::Seconds(30)));
  // The child has no argument that tells it from others; its folder does.
  const auto in_folder = [&] {
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      std::error_code error;
      if (std::filesystem::read_symlink(entry.path() / "cwd", error) == folder.path()) return true;
    }
    return false;
  };
  ASSERT_TRUE(in_folder());
  supervisor.Signal(SIGKILL);
  supervisor.Wait();
  const absl::Time end = absl::Now() + absl::Seconds(5);
  while (in_folder() && absl::Now() < end) absl::SleepFor(absl::Milliseconds(10));
  EXPECT_FALSE(in_folder());
}

TEST(ChildProcessRunnerTest, ManyChildrenAtATimeDoNotDisturbEachOther) {
  std::vector<std::thread> threads;
  std::atomic<int> good = 0;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&, i] {
      AttemptFolder job(Selftest(), static_cast<uint64_t>(i));
      SelftestRunner direct;
      ChildProcessRunner child(Config());
      const auto output = job.Run(child);
      if (!output.ok()) return;
      AttemptFolder same(Selftest(), static_cast<uint64_t>(i));
      if (AttemptFolder::Contents(*output) == AttemptFolder::Contents(*same.Run(direct))) ++good;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(good, 8);
}

}  // namespace
}  // namespace poise::jobs
