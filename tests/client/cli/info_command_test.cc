#include <gmock/gmock.h>

#include <fstream>

#include "core/motion/io/clip_file.h"
#include "tests/client/cli/poise_program.h"
#include "tests/support/data_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_clips.h"

namespace poise::testing {
namespace {

using ::testing::HasSubstr;

class InfoCommandTest : public ::testing::Test {
 protected:
  InfoCommandTest() {
    const Status written = motion::WriteBvhFile(Path("swing.bvh"), SwingingClip(61, 60));
    EXPECT_TRUE(written.ok()) << written;
  }
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }

  TemporaryFolder folder_;
};

TEST_F(InfoCommandTest, TheJsonHasTheFixedFields) {
  const PoiseRun run = RunPoise({"info", Path("swing.bvh"), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.out;
  ASSERT_EQ(run.JsonLines().size(), 1u);
  const base::Json json = run.JsonLines()[0];
  EXPECT_EQ(json.at("format"), "bvh");
  EXPECT_EQ(json.at("frames"), 61);
  EXPECT_NEAR(json.at("fps").get<double>(), 60, 1e-3);
  EXPECT_NEAR(json.at("duration_s").get<double>(), 1, 1e-4);
  EXPECT_EQ(json.at("joints"), 21);
  EXPECT_EQ(json.at("unit_m"), 0.01);
  EXPECT_EQ(json.at("up"), "y");
  EXPECT_EQ(json.at("roles").at("left_hip"), "left_hip");
  EXPECT_TRUE(json.at("missing_roles").empty());
  for (const char* name :
       {"foot_skate_mps", "penetration_mean_m", "penetration_max_m", "float_mean_m",
        "self_penetration_max_m", "acceleration_rms_mps2", "jerk_rms_mps3"}) {
    EXPECT_TRUE(json.at("plausibility").at(name).is_number()) << name;
  }
}

TEST_F(InfoCommandTest, SeveralFilesGiveALineEach) {
  const PoiseRun run = RunPoise({"info", Path("swing.bvh"), Path("swing.bvh"), "--json"});
  EXPECT_EQ(run.JsonLines().size(), 2u);
}

TEST_F(InfoCommandTest, TheTextNamesTheDetection) {
  const PoiseRun run = RunPoise({"info", Path("swing.bvh")});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("61 at 60 fps"));
  EXPECT_THAT(run.out, HasSubstr("foot skate"));
  EXPECT_THAT(run.out, HasSubstr("note"));
}

TEST_F(InfoCommandTest, FlagsOverrideTheDetection) {
  const PoiseRun run =
      RunPoise({"info", Path("swing.bvh"), "--unit", "0.02", "--fps", "30", "--json"});
  EXPECT_EQ(run.JsonLines()[0].at("unit_m"), 0.02);
  EXPECT_EQ(run.JsonLines()[0].at("fps"), 30.0);
}

TEST_F(InfoCommandTest, JointsCanBeMappedByHand) {
  std::ofstream(Path("map.json")) << R"({"spine": "chest"})";
  const PoiseRun mapped =
      RunPoise({"info", Path("swing.bvh"), "--roles", Path("map.json"), "--json"});
  EXPECT_EQ(mapped.JsonLines()[0].at("roles").at("spine"), "chest");
  std::ofstream(Path("bad.json")) << R"({"tail": "chest"})";
  const PoiseRun bad = RunPoise({"info", Path("swing.bvh"), "--roles", Path("bad.json"), "--json"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_EQ(bad.Error().at("reason"), "UNKNOWN_ROLE");
}

TEST_F(InfoCommandTest, BadFlagsNameTheirField) {
  for (const auto& [flag, value] :
       {std::pair{"unit", "furlong"}, {"unit", "-1"}, {"up", "x"}, {"fps", "0"}, {"fps", "nan"}}) {
    const PoiseRun run =
        RunPoise({"info", Path("swing.bvh"), std::string("--") + flag + "=" + value, "--json"});
    EXPECT_EQ(run.exit_code, 2) << flag;
    EXPECT_EQ(run.Error().at("field"), flag);
  }
}

TEST_F(InfoCommandTest, AMissingFileExitsWithThree) {
  const PoiseRun json = RunPoise({"info", Path("none.bvh"), "--json"});
  EXPECT_EQ(json.exit_code, 3);
  EXPECT_EQ(json.Error().at("code"), "NOT_FOUND");
  const PoiseRun text = RunPoise({"info", Path("none.bvh")});
  EXPECT_EQ(text.exit_code, 3);
  EXPECT_THAT(text.err, HasSubstr("none.bvh"));
  EXPECT_EQ(text.out, "");
}

TEST_F(InfoCommandTest, AMalformedFileExitsWithTwoAndNamesTheLine) {
  std::ofstream(Path("bad.bvh")) << "HIERARCHY\nROOT hips\n{\n  OFFSET 0 0\n";
  const PoiseRun run = RunPoise({"info", Path("bad.bvh"), "--json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.Error().at("reason"), "MALFORMED_BVH");
  EXPECT_THAT(run.Error().at("message").get<std::string>(), HasSubstr("bad.bvh"));
}

TEST_F(InfoCommandTest, AnAmcFindsItsSkeleton) {
  POISE_REQUIRE_DATA("hdm05/kickLFront1Reps");
  const PoiseRun run = RunPoise(
      {"info", DataPath("hdm05/kickLFront1Reps/HDM_bd_kickLFront1Reps_001_120.amc").string(),
       "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.out;
  EXPECT_EQ(run.JsonLines()[0].at("frames"), 161);
  EXPECT_EQ(run.JsonLines()[0].at("joints"), 31);
  EXPECT_NEAR(run.JsonLines()[0].at("unit_m").get<double>(), 0.056444, 1e-6);
}

}  // namespace
}  // namespace poise::testing
