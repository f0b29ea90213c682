#include <gmock/gmock.h>

#include "core/motion/io/clip_file.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "tests/client/cli/poise_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_clips.h"

namespace poise::testing {
namespace {

class ConvertCommandTest : public ::testing::Test {
 protected:
  ConvertCommandTest() : clip_(SwingingClip(121)) {
    EXPECT_TRUE(motion::WriteBvhFile(Path("in.bvh"), clip_).ok());
  }
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }

  // Runs `poise convert in.bvh out.bvh FLAGS...` and reads the result.
  motion::ClipFile Convert(std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"convert", Path("in.bvh"), Path("out.bvh")});
    const PoiseRun run = RunPoise(flags);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    StatusOr<motion::ClipFile> file = motion::ReadClipFile(Path("out.bvh"));
    EXPECT_TRUE(file.ok()) << file.status();
    return *std::move(file);
  }

  TemporaryFolder folder_;
  motion::Clip clip_;
};

void ExpectSamePositions(const motion::Clip& clip, const motion::Clip& other) {
  ASSERT_EQ(clip.num_frames(), other.num_frames());
  const motion::WorldPoses a = motion::ForwardKinematics(clip);
  const motion::WorldPoses b = motion::ForwardKinematics(other);
  double worst = 0;
  for (int joint = 0; joint < clip.num_joints(); ++joint) {
    // BVH lists joints depth first, whatever their order was.
    const int counterpart = *other.skeleton()->Find(clip.skeleton()->joint(joint).name);
    for (int frame = 0; frame < clip.num_frames(); ++frame) {
      worst = std::max(worst, (a.position(frame, joint) - b.position(frame, counterpart)).norm());
    }
  }
  EXPECT_LT(worst, 1e-5);
}

TEST_F(ConvertCommandTest, WithoutFlagsTheMotionStays) {
  ExpectSamePositions(Convert({}).clip, clip_);
}

TEST_F(ConvertCommandTest, AnotherUnitAndUpAxisAreTheSameMotion) {
  const motion::ClipFile file = Convert({"--to-unit", "m", "--to-up", "z"});
  EXPECT_EQ(file.convention.unit_m, 1.0);
  EXPECT_EQ(file.convention.up, motion::UpAxis::kZ);
  ExpectSamePositions(file.clip, clip_);
}

TEST_F(ConvertCommandTest, ToFpsResamples) {
  const motion::ClipFile file = Convert({"--to-fps", "30"});
  EXPECT_EQ(file.clip.num_frames(), 31);
  EXPECT_NEAR(file.clip.frame_rate(), 30, 1e-3);
}

TEST_F(ConvertCommandTest, MirrorSwapsTheSides) {
  const motion::Clip mirrored = Convert({"--mirror"}).clip;
  const motion::WorldPoses before = motion::ForwardKinematics(clip_);
  const motion::WorldPoses after = motion::ForwardKinematics(mirrored);
  const int left = *clip_.skeleton()->Find("left_wrist");
  const int right = *mirrored.skeleton()->Find("right_wrist");
  const motion::Vec3 seen(-before.position(50, left).x(), before.position(50, left).y(),
                          before.position(50, left).z());
  EXPECT_LT((after.position(50, right) - seen).norm(), 1e-4);
}

TEST_F(ConvertCommandTest, ReduceLeavesSixteenJoints) {
  EXPECT_EQ(Convert({"--reduce", "composed"}).clip.num_joints(), 16);
}

TEST_F(ConvertCommandTest, RetargetTakesTheOtherBody) {
  Convert({"--reduce", "composed"});
  std::filesystem::rename(Path("out.bvh"), Path("body.bvh"));
  EXPECT_EQ(Convert({"--retarget", Path("body.bvh")}).clip.num_joints(), 16);
}

TEST_F(ConvertCommandTest, OnlyBvhIsWritten) {
  const PoiseRun run = RunPoise({"convert", Path("in.bvh"), Path("out.amc"), "--json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.Error().at("reason"), "UNSUPPORTED_OUTPUT");
  EXPECT_EQ(run.Error().at("field"), "out");
}

TEST_F(ConvertCommandTest, AnUnknownReductionNamesTheKnownOnes) {
  const PoiseRun run =
      RunPoise({"convert", Path("in.bvh"), Path("out.bvh"), "--reduce", "all", "--json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.Error().at("field"), "reduce");
}

}  // namespace
}  // namespace poise::testing
