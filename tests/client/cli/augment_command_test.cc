// `poise augment` against a real poised.
#include <gmock/gmock.h>

#include <fstream>

#include "absl/time/clock.h"
#include "core/motion/io/clip_file.h"
#include "tests/client/cli/poise_program.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_clips.h"

namespace poise::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string ReadAll(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

class AugmentCommandTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { server_ = new PoiseServer(/*workers=*/0); }
  static void TearDownTestSuite() { delete server_; }

  AugmentCommandTest() : environment_{{"POISE_SERVER", server_->address()}} {
    EXPECT_TRUE(motion::WriteBvhFile(Path("swing.bvh"), SwingingClip(121)).ok());
  }

  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }

  std::vector<std::string> Arguments(std::vector<std::string> more) const {
    more.insert(more.begin(), {"augment", Path("swing.bvh"), "--out", Path("out")});
    return more;
  }
  PoiseRun Augment(std::vector<std::string> more) const {
    return RunPoise(Arguments(std::move(more)), environment_);
  }

  static PoiseServer* server_;  // all tests but one leave it alone
  TemporaryFolder folder_;
  std::map<std::string, std::string> environment_;
};

PoiseServer* AugmentCommandTest::server_ = nullptr;

TEST_F(AugmentCommandTest, EveryVariantIsAFileAndAJsonLine) {
  const PoiseRun run =
      Augment({"--method", "ik+timewarp", "--class", "kick", "-n", "5", "--seed", "1", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  EXPECT_EQ(run.err, "");
  const std::vector<base::Json> lines = run.JsonLines();
  ASSERT_EQ(lines.size(), 5u);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(lines[i].at("index"), i);
    EXPECT_EQ(lines[i].at("method"), "ik+timewarp");
    EXPECT_EQ(lines[i].at("target_m").size(), 3u);
    EXPECT_TRUE(lines[i].at("reached_error_m").is_number());
    EXPECT_TRUE(lines[i].at("reachable").is_boolean());
    EXPECT_TRUE(lines[i].at("plausibility").at("jerk_rms_mps3").is_number());
    const auto file = motion::ReadClipFile(lines[i].at("file").get<std::string>());
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_EQ(file->clip.num_joints(), 21);
    EXPECT_EQ(file->convention.unit_m, 0.01);
  }
}

TEST_F(AugmentCommandTest, TheSameSeedWritesTheSameBytes) {
  ASSERT_EQ(Augment({"-n", "2", "--seed", "7", "--out", Path("a")}).exit_code, 0);
  ASSERT_EQ(Augment({"-n", "2", "--seed", "7", "--out", Path("b")}).exit_code, 0);
  ASSERT_EQ(Augment({"-n", "2", "--seed", "8", "--out", Path("c")}).exit_code, 0);
  const char* name = "swing_ik+timewarp_001.bvh";
  EXPECT_FALSE(ReadAll(folder_.path() / "a" / name).empty());
  EXPECT_EQ(ReadAll(folder_.path() / "a" / name), ReadAll(folder_.path() / "b" / name));
  EXPECT_NE(ReadAll(folder_.path() / "a" / name), ReadAll(folder_.path() / "c" / name));
}

TEST_F(AugmentCommandTest, TheTextEndsWithTheTableAndTheFolder) {
  const PoiseRun run = Augment({"-n", "3"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3 variants, mean"));
  EXPECT_THAT(run.out, HasSubstr(Path("out")));
  EXPECT_THAT(run.err, HasSubstr("3 of 3 variants"));
  EXPECT_THAT(run.err, Not(HasSubstr("\r")));
}

TEST_F(AugmentCommandTest, SourcesOfOneNameKeepTheirVariantsApart) {
  std::filesystem::create_directory(Path("more"));
  std::filesystem::copy_file(Path("swing.bvh"), Path("more/swing.bvh"));
  const PoiseRun run = Augment({Path("more/swing.bvh"), "--method", "noise", "-n", "1", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.out;
  EXPECT_EQ(run.JsonLines()[0].at("file"), Path("out/swing_noise_000.bvh"));
  EXPECT_EQ(run.JsonLines()[1].at("file"), Path("out/swing-2_noise_000.bvh"));
  EXPECT_TRUE(run.JsonLines()[0].at("reachable").is_null());
}

TEST_F(AugmentCommandTest, WrongRequestsExitWithTwoAndNameTheField) {
  const std::pair<std::vector<std::string>, std::string> wrong[] = {
      {{"--method", "magic"}, "method"}, {{"--class", "swim"}, "action_class"},
      {{"--preset", "best"}, "preset"},  {{"-n", "0"}, "variants_per_source"},
      {{"--set", "ik.radius"}, "set"},   {{"--set", "ik.no_such_key=1"}, "ik.no_such_key"}};
  for (const auto& [flags, field] : wrong) {
    std::vector<std::string> arguments = flags;
    arguments.push_back("--json");
    const PoiseRun run = Augment(arguments);
    EXPECT_EQ(run.exit_code, 2) << run.out;
    EXPECT_EQ(run.Error().at("field"), field) << run.out;
  }
}

TEST_F(AugmentCommandTest, CtrlCStopsTheWorkAndExitsWithSix) {
  std::vector<std::string> arguments = Arguments({"-n", "1000000", "--json"});
  arguments.insert(arguments.begin(), ProgramPath("poise"));
  Process process(arguments, environment_);
  ASSERT_TRUE(process.WaitForOutput("\n", absl::Seconds(30))) << process.ErrorOutput();
  const absl::Time start = absl::Now();
  process.Signal(SIGINT);
  EXPECT_EQ(process.Wait(absl::Seconds(20)), 6);
  EXPECT_LT(absl::Now() - start, absl::Seconds(5));
  EXPECT_THAT(process.Output(), HasSubstr(R"("code":"CANCELLED")"));
}

TEST_F(AugmentCommandTest, ATimeLimitExitsWithSix) {
  const PoiseRun run = Augment({"-n", "1000000", "--timeout", "0.5", "--json"});
  EXPECT_EQ(run.exit_code, 6);
  EXPECT_EQ(run.Error().at("code"), "DEADLINE_EXCEEDED");
}

TEST_F(AugmentCommandTest, AServerThatDiesMidwayIsReported) {
  PoiseServer mortal(/*workers=*/0);
  environment_["POISE_SERVER"] = mortal.address();
  std::vector<std::string> arguments = Arguments({"-n", "1000000", "--json"});
  arguments.insert(arguments.begin(), ProgramPath("poise"));
  Process process(arguments, environment_);
  ASSERT_TRUE(process.WaitForOutput("\n", absl::Seconds(30)));
  mortal.Kill();
  EXPECT_EQ(process.Wait(absl::Seconds(20)), 5);
  EXPECT_THAT(process.Output(), HasSubstr("CONNECTION_LOST"));
}

TEST_F(AugmentCommandTest, WithoutAServerOneLineSaysHowToStartOne) {
  environment_["POISE_SERVER"] = "127.0.0.1:1";
  const PoiseRun run = Augment({});
  EXPECT_EQ(run.exit_code, 5);
  EXPECT_EQ(run.err,
            "poise: no server answers at 127.0.0.1:1; start one: poised --listen 127.0.0.1:1 "
            "--data-dir ~/.poise\n");
  EXPECT_EQ(Augment({"--json"}).Error().at("code"), "UNAVAILABLE");
}

TEST_F(AugmentCommandTest, AFolderThatCannotBeMadeExitsWithFour) {
  std::ofstream(Path("occupied")) << "a file";
  const PoiseRun run = Augment({"--out", Path("occupied"), "--json"});
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_EQ(run.Error().at("reason"), "CANNOT_WRITE");
}

}  // namespace
}  // namespace poise::testing
