// `poise push` against a real server.
#include <gmock/gmock.h>

#include <filesystem>
#include <memory>

#include "core/motion/io/clip_file.h"
#include "tests/client/cli/poise_program.h"
#include "tests/support/temporary_folder.h"

namespace poise::testing {
namespace {

namespace fs = std::filesystem;

class PushCommandTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { server_ = std::make_unique<PoiseServer>(/*workers=*/0); }
  static void TearDownTestSuite() { server_.reset(); }

  PoiseRun Push(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "push");
    arguments.push_back("--json");
    return server_->Poise(std::move(arguments));
  }
  std::string Folder(const std::string& name) { return (folder_.path() / name).string(); }

  TemporaryFolder folder_;
  static std::unique_ptr<PoiseServer> server_;
};

std::unique_ptr<PoiseServer> PushCommandTest::server_;

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
