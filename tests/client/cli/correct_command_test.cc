// `poise correct` against a real poised with workers of its own.
#include <gmock/gmock.h>
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "absl/time/clock.h"
#include "core/motion/io/clip_file.h"
#include "tests/client/cli/poise_program.h"
#include "tests/support/process.h"
#include "tests/support/sanitizer.h"

namespace poise::testing {
namespace {

using ::testing::HasSubstr;

class CorrectCommandTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { server_ = std::make_unique<PoiseServer>(/*workers=*/2); }
  static void TearDownTestSuite() { server_.reset(); }

  static std::string Sample(const std::string& name) {
    return std::string(POISE_SAMPLES_DIR) + "/" + name + ".bvh";
  }
  static std::string Path(const std::string& name) { return server_->Path(name); }
  static PoiseRun Poise(std::vector<std::string> arguments) {
    return server_->Poise(std::move(arguments));
  }
  static std::string ReadAll(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  }

  static std::unique_ptr<PoiseServer> server_;
};

std::unique_ptr<PoiseServer> CorrectCommandTest::server_;

TEST_F(CorrectCommandTest, EveryClipIsAJobAJsonLineAndItsFiles) {
  const PoiseRun run =
      Poise({"correct", Sample("kick"), Sample("punch"), "--method", "ik", "-n", "3", "--effort",
             "fast", "--set", "learning.rollouts=3", "--seed", "5", "--out", Path("a"), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  EXPECT_EQ(run.err, "");
  const std::vector<base::Json> lines = run.JsonLines();
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0]["clip"], "kick");
  EXPECT_EQ(lines[1]["clip"], "punch");
  for (const base::Json& line : lines) {
    EXPECT_EQ(line["state"], "SUCCEEDED");
    EXPECT_GT(line["wall_s"], 0);
    EXPECT_GT(line["samples"], 1000);
    EXPECT_EQ(line["stopped_by"], "finished");
    EXPECT_TRUE(line["zero_policy"]["reward_normalised"].is_number());
    EXPECT_EQ(line["reward_curve"].size(), 3u);
    EXPECT_TRUE(line["reward_curve"][2]["residual_force_mean_bw"].is_number());
    ASSERT_EQ(line["variants"].size(), 3u);
    for (const base::Json& variant : line["variants"]) {
      EXPECT_TRUE(variant["completed"].get<bool>());
      EXPECT_TRUE(variant["before"]["foot_skate_mps"].is_number());
      EXPECT_TRUE(variant["after"]["residual_torque_mean_nm"].is_number());
      EXPECT_TRUE(motion::ReadClipFile(variant["file"].get<std::string>()).ok());
    }
  }
  EXPECT_EQ(lines[0]["variants"][2]["file"], Path("a/kick_ik_002.bvh"));
  const base::Json manifest = base::Json::parse(ReadAll(Path("a/kick.json")));
  EXPECT_EQ(manifest["report"]["clips"][0]["variants"][0]["seed"], lines[0]["variants"][0]["seed"]);
  EXPECT_EQ(manifest["parameters"]["effort"], "fast");
}

TEST_F(CorrectCommandTest, TheSameSeedWritesTheSameBytes) {
  for (const auto& [out, seed] :
       {std::pair("s1", "1"), std::pair("s2", "1"), std::pair("s3", "2")}) {
    ASSERT_EQ(Poise({"correct", Sample("kick"), "-n", "2", "--effort", "instant", "--seed", seed,
                     "--out", Path(out)})
                  .exit_code,
              0);
  }
  const std::string name = "/kick_ik_001.bvh";
  EXPECT_FALSE(ReadAll(Path("s1") + name).empty());
  EXPECT_EQ(ReadAll(Path("s1") + name), ReadAll(Path("s2") + name));
  EXPECT_NE(ReadAll(Path("s1") + name), ReadAll(Path("s3") + name));
  EXPECT_EQ(ReadAll(Path("s1/kick.json")), ReadAll(Path("s2/kick.json")));
}

TEST_F(CorrectCommandTest, TheTablesHaveForceAndTorqueBesideTheReward) {
  const PoiseRun run = Poise({"correct", Sample("kick"), "--method", "none", "--effort", "instant",
                              "--out", Path("none")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("1 variant before"));
  EXPECT_THAT(run.out, HasSubstr("zero policy"));
  EXPECT_THAT(run.out, HasSubstr("reward  force BW  peak BW  torque N m"));
  EXPECT_THAT(run.out, HasSubstr("1/1"));
  EXPECT_THAT(run.err, HasSubstr("BW, torque"));
}

TEST_F(CorrectCommandTest, AFallIsSaidAndNoFailure) {
  const PoiseRun run = Poise({"correct", Sample("kick"), "--method", "none", "--effort", "instant",
                              "--residual", "none", "--set", "tracking.pelvis_stiffness=0", "--set",
                              "tracking.pelvis_damping=0", "--out", Path("fall")});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("variant 0 was not completed"));
  EXPECT_THAT(run.out, HasSubstr("0/1"));
}

TEST_F(CorrectCommandTest, DetachedItIsAJobLikeAnyOther) {
  const PoiseRun run = Poise({"correct", Sample("kick"), "--method", "none", "--effort", "instant",
                              "--detach", "--request-id", "night-1", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.out;
  const std::string job = run.JsonLines()[0]["job"];
  EXPECT_TRUE(run.JsonLines()[0]["variants"].is_null());
  EXPECT_EQ(Poise({"jobs", "watch", job}).exit_code, 0);
  const PoiseRun result = Poise({"jobs", "result", job, "--out", Path("later"), "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_TRUE(std::filesystem::exists(Path("later/kick_none_000.bvh")));
  const PoiseRun again =
      Poise({"correct", Sample("kick"), "--method", "none", "--effort", "instant", "--request-id",
             "night-1", "--out", Path("again"), "--json"});
  EXPECT_EQ(again.JsonLines()[0]["job"], job) << "the same id is the same job";
  EXPECT_EQ(again.JsonLines()[0]["state"], "SUCCEEDED");
}

TEST_F(CorrectCommandTest, FullLearnsAPolicyFirst) {
  POISE_SKIP_WHERE_INSTRUMENTED();
  const PoiseRun run =
      Poise({"correct", Sample("kick"), "-n", "2", "--effort", "full", "--residual", "pd_rfc",
             "--set", "learning.rollouts=2", "--set", "imitation.max_samples=4000", "--set",
             "imitation.held_out=1", "--out", Path("full"), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  const base::Json line = run.JsonLines()[0];
  EXPECT_EQ(line["stopped_by"], "max_samples");
  EXPECT_GE(line["samples"], 4000);
  EXPECT_GE(line["reward_curve"].size(), 2u);
  for (const base::Json& variant : line["variants"]) EXPECT_TRUE(variant["completed"].get<bool>());
}

TEST_F(CorrectCommandTest, TimeThatIsUpIsSaid) {
  const PoiseRun run =
      Poise({"correct", Sample("kick"), "-n", "2", "--set", "learning.rollouts=1000",
             "--max-seconds", "3", "--out", Path("short"), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.out;
  const base::Json line = run.JsonLines()[0];
  EXPECT_EQ(line["stopped_by"], "max_seconds");
  for (const base::Json& variant : line["variants"]) EXPECT_TRUE(variant["after"].is_object());
}

TEST_F(CorrectCommandTest, CtrlCCancelsTheJob) {
  Process process({ProgramPath("poise"), "correct", Sample("kick"), "-n", "50", "--set",
                   "learning.rollouts=1000", "--out", Path("never"), "--json"},
                  {{"POISE_SERVER", server_->address()}});
  const auto running = [&] {
    const PoiseRun list =
        Poise({"jobs", "list", "--state", "RUNNING", "--kind", "correct", "--json"});
    return !list.out.empty();
  };
  const absl::Time patience = absl::Now() + absl::Seconds(60);
  while (!running() && absl::Now() < patience) absl::SleepFor(absl::Milliseconds(100));
  process.Signal(SIGINT);
  EXPECT_EQ(process.Wait(), 6);
  EXPECT_THAT(process.Output(), HasSubstr("\"state\":\"CANCELLED\""));
  EXPECT_FALSE(running());
}

TEST_F(CorrectCommandTest, MistakesExitWithTwoAndNameTheField) {
  const auto error = [&](std::vector<std::string> more, int exit_code) {
    more.insert(more.begin(), {"correct", Sample("kick"), "--out", Path("x"), "--json"});
    const PoiseRun run = Poise(std::move(more));
    EXPECT_EQ(run.exit_code, exit_code) << run.out;
    return run.Error();
  };
  EXPECT_EQ(error({"--effort", "slow"}, 2)["field"], "effort");
  EXPECT_EQ(error({"--method", "magic"}, 2)["reason"], "UNKNOWN_METHOD");
  EXPECT_EQ(error({"--set", "learning.rolouts=3"}, 2)["field"], "spec.parameters.learning.rolouts");
  EXPECT_EQ(error({"--method", "none", "-n", "3"}, 2)["reason"], "BAD_VARIANT_COUNT");
  EXPECT_EQ(error({"--residual", "rfc"}, 2)["reason"], "RESIDUAL_NEEDS_LEARNING");
  EXPECT_EQ(Poise({"correct", Path("none.bvh")}).exit_code, 3);
}

}  // namespace
}  // namespace poise::testing
