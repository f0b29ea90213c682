// `poise fk` on a file whose numbers can be worked out by hand.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

#include "tests/client/cli/poise_program.h"
#include "tests/support/temporary_folder.h"

namespace poise::testing {
namespace {

using ::testing::HasSubstr;

// An arm of 10 cm and a tip 5 cm further, along Y at rest. Frame 0: at rest, 1 m up. Frame 1: the
// root turned by 90 degrees about Z, so that the arm points along -X. Frame 2: the elbow turned by
// 90 degrees about X, so that the tip points along Z.
constexpr char kArm[] =
    "HIERARCHY\n"
    "ROOT base\n{\n"
    "  OFFSET 0 0 0\n"
    "  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "  JOINT elbow\n  {\n"
    "    OFFSET 0 10 0\n"
    "    CHANNELS 3 Zrotation Xrotation Yrotation\n"
    "    End Site\n    {\n      OFFSET 0 5 0\n    }\n  }\n}\n"
    "MOTION\nFrames: 3\nFrame Time: 0.01\n"
    "0 100 0 0 0 0 0 0 0\n"
    "0 100 0 90 0 0 0 0 0\n"
    "0 100 0 0 0 0 0 90 0\n";

class FkCommandTest : public ::testing::Test {
 protected:
  FkCommandTest() { std::ofstream(folder_.path() / "arm.bvh") << kArm; }

  std::vector<std::string> Arguments(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {
        "fk", (folder_.path() / "arm.bvh").string(), "--unit", "cm", "--up", "y"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  TemporaryFolder folder_;
};

TEST_F(FkCommandTest, TheCsvHoldsJointsAndEndSitesInMetres) {
  const std::string csv = (folder_.path() / "x.csv").string();
  const PoiseRun run = RunPoise(Arguments({"--frames", "0,1-2", "--out", csv}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::ifstream stream(csv);
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  EXPECT_EQ(text,
            "frame,joint,x,y,z\n"
            "0,base,0.000000,1.000000,0.000000\n"
            "0,elbow,0.000000,1.100000,0.000000\n"
            "0,elbow_end,0.000000,1.150000,0.000000\n"
            "1,base,0.000000,1.000000,0.000000\n"
            "1,elbow,-0.100000,1.000000,0.000000\n"
            "1,elbow_end,-0.150000,1.000000,0.000000\n"
            "2,base,0.000000,1.000000,0.000000\n"
            "2,elbow,0.000000,1.100000,0.000000\n"
            "2,elbow_end,0.000000,1.100000,0.050000\n");
}

TEST_F(FkCommandTest, WithoutFramesAllOfThemGoToStandardOutput) {
  const PoiseRun run = RunPoise(Arguments({}));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 1 + 3 * 3);
}

TEST_F(FkCommandTest, JsonRowsHoldTheSameNumbers) {
  const PoiseRun run = RunPoise(Arguments({"--frames", "1", "--json"}));
  ASSERT_EQ(run.JsonLines().size(), 3u);
  EXPECT_EQ(run.JsonLines()[2].at("joint"), "elbow_end");
  EXPECT_NEAR(run.JsonLines()[2].at("x").get<double>(), -0.15, 1e-9);
}

TEST_F(FkCommandTest, FramesThatAreNotInTheClipAreRefused) {
  for (const char* frames : {"3", "-1", "2-1", "0,,1", "one", "0-9", "99999999999"}) {
    const PoiseRun run = RunPoise(Arguments({std::string("--frames=") + frames, "--json"}));
    EXPECT_EQ(run.exit_code, 2) << frames;
    EXPECT_EQ(run.Error().at("field"), "frames") << frames;
    EXPECT_THAT(run.Error().at("message").get<std::string>(), HasSubstr("from 0 to 2")) << frames;
  }
}

TEST_F(FkCommandTest, AFileThatCannotBeWrittenIsAFailedPrecondition) {
  const PoiseRun run = RunPoise(Arguments({"--out", "/nowhere/x.csv", "--json"}));
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_EQ(run.Error().at("reason"), "CANNOT_WRITE");
}

}  // namespace
}  // namespace poise::testing
