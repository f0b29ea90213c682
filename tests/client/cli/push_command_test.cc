// `poise push` against a real server.
#include <gmock/gmock.h>
#include <signal.h>

#include <filesystem>

#include "core/motion/io/clip_file.h"
#include "tests/client/cli/poise_program.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace poise::testing {
namespace {

namespace fs = std::filesystem;

class PushCommandTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    data_ = new TemporaryFolder;
    server_ = new Process({ProgramPath("poised"), "--listen", "127.0.0.1:0", "--workers", "0",
                           "--lame-duck-seconds", "0", "--data-dir", data_->path() / "data"});
    ASSERT_TRUE(server_->WaitForOutput("\n", absl::Seconds(60))) << server_->ErrorOutput();
    const std::string ready = server_->Output();
    address_ = base::Json::parse(ready.substr(0, ready.find('\n'))).at("address");
  }
  static void TearDownTestSuite() {
    server_->Signal(SIGTERM);
    EXPECT_EQ(server_->Wait(), 0);
    delete server_;
    delete data_;
  }

  PoiseRun Push(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "push");
    arguments.push_back("--json");
    return RunPoise(std::move(arguments), {{"POISE_SERVER", address_}});
  }
  std::string Folder(const std::string& name) { return (folder_.path() / name).string(); }

  TemporaryFolder folder_;
  static TemporaryFolder* data_;
  static Process* server_;
  static std::string address_;
};

TemporaryFolder* PushCommandTest::data_ = nullptr;
Process* PushCommandTest::server_ = nullptr;
std::string PushCommandTest::address_;

TEST_F(PushCommandTest, ALineOfTenIsForecastAndWritten) {
  const PoiseRun run = Push({"--people", "line:10", "--push", "0:strong", "--out", Folder("line")});
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  const base::Json answer = run.JsonLines().back();
  ASSERT_EQ(answer.at("people").size(), 10u);
  double before = -1;
  for (const base::Json& person : answer.at("people")) {
    EXPECT_GT(person.at("onset_s").get<double>(), before);
    before = person.at("onset_s").get<double>();
    EXPECT_GT(person.at("peak_hip_mps").get<double>(), 0.1);
    const auto clip = motion::ReadClipFile(person.at("file").get<std::string>());
    ASSERT_TRUE(clip.ok()) << clip.status();
    EXPECT_EQ(clip->clip.num_frames(), 121);
  }
  EXPECT_GT(answer.at("min_distance_m").get<double>(), 0.25);
}

TEST_F(PushCommandTest, WhatItWritesCanBePushedAgain) {
  const PoiseRun first =
      Push({"--people", "diamond:13", "--push", "0:40Ns:180", "--out", Folder("a")});
  ASSERT_EQ(first.exit_code, 0) << first.out;
  const PoiseRun second = Push({"--people", Folder("a/scene.json"), "--out", Folder("b")});
  ASSERT_EQ(second.exit_code, 0) << second.out;
  const base::Json a = first.JsonLines().back(), b = second.JsonLines().back();
  EXPECT_NEAR(a["people"][0]["peak_hip_mps"], b["people"][0]["peak_hip_mps"].get<double>(), 1e-3);
  EXPECT_NEAR(a["min_distance_m"], b["min_distance_m"].get<double>(), 1e-3);
}

TEST_F(PushCommandTest, MistakesAreUsageErrorsWithReasons) {
  const auto reason = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--out", Folder("none")});
    const PoiseRun run = Push(std::move(arguments));
    EXPECT_EQ(run.exit_code, 2) << run.out;
    return run.Error().at("reason").get<std::string>();
  };
  EXPECT_EQ(reason({"--people", "line:0"}), "BAD_FORMATION");
  EXPECT_EQ(reason({"--people", "line:3:0.1", "--push", "0:weak"}), "OVERLAPPING_PEOPLE");
  EXPECT_EQ(reason({"--people", "line:3", "--push", "3:weak"}), "UNKNOWN_PERSON");
  EXPECT_EQ(reason({"--people", "line:3", "--push", "0:nanNs"}), "BAD_FORCE");
  EXPECT_EQ(reason({"--people", "line:3", "--mass", "0"}), "BAD_MASS");
  EXPECT_EQ(reason({"--people", "line:3", "--push", "0:weak@5"}), "PUSH_OUTSIDE_CLIP");
}

}  // namespace
}  // namespace poise::testing
