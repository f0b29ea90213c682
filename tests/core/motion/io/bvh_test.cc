#include <gtest/gtest.h>

#include <numbers>

#include "core/motion/io/clip_file.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

// A trunk of 1.7 units with whatever channels and frames.
std::string Trunk(const std::string& root_channels, const std::string& head_channels,
                  const std::string& frames) {
  return "HIERARCHY\nROOT hips\n{\n OFFSET 0 0 0\n CHANNELS " + root_channels +
         "\n JOINT head\n {\n  OFFSET 0 100 0\n  CHANNELS " + head_channels +
         "\n  End Site\n  {\n   OFFSET 0 100 0\n  }\n }\n}\nMOTION\n" + frames;
}

ClipFile Read(const std::string& text, const ClipHints& hints = {}) {
  auto file = DecodeClip("test.bvh", text, ClipFormat::kUnknown, hints);
  EXPECT_TRUE(file.ok()) << file.status();
  return *std::move(file);
}

void ExpectSame(const Clip& a, const Clip& b, double tolerance) {
  // A BVH lists joints depth first, so the order may change.
  std::vector<int> there;
  for (const Joint& joint : a.skeleton()->joints()) {
    there.push_back(b.skeleton()->Find(joint.name).value());
    EXPECT_LT((joint.offset - b.skeleton()->joint(there.back()).offset).norm(), tolerance);
  }
  ASSERT_EQ(a.num_joints(), b.num_joints());
  ASSERT_EQ(a.num_frames(), b.num_frames());
  EXPECT_NEAR(a.frame_rate(), b.frame_rate(), 1e-6);
  for (int frame = 0; frame < a.num_frames(); ++frame) {
    EXPECT_LT((a.root_position(frame) - b.root_position(frame)).norm(), tolerance);
    for (int joint = 0; joint < a.num_joints(); ++joint) {
      EXPECT_LT(math::GeodesicDistance(a.rotation(frame, joint), b.rotation(frame, there[joint])),
                tolerance);
    }
  }
}

TEST(BvhTest, ChannelsTurnInTheOrderOfTheirColumns) {
  const ClipFile file = Read(
      Trunk("6 Yrotation Xposition Zposition Yposition Xrotation Zrotation",
            "2 Xrotation Yrotation", "Frames: 1\nFrame Time: .05\n10 100 300 200 20 30 40 50\n"),
      {.unit_m = 0.01, .up = UpAxis::kY});
  EXPECT_LT((file.clip.root_position(0) - Vec3(1, 2, 3)).norm(), 1e-12);
  const auto turn = [](double degrees, const Vec3& axis) {
    return Quat(Eigen::AngleAxisd(degrees * kRadians, axis));
  };
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  EXPECT_LT(
      math::GeodesicDistance(file.clip.rotation(0, 0), turn(10, y) * turn(20, x) * turn(30, z)),
      1e-12);
  EXPECT_LT(math::GeodesicDistance(file.clip.rotation(0, 1), turn(40, x) * turn(50, y)), 1e-12);
  EXPECT_EQ(file.clip.frame_rate(), 20);
}

TEST(BvhTest, ChannelsOfTheSourceAreWrittenAgain) {
  const ClipFile file = Read(Trunk("6 Yrotation Xposition Zposition Yposition Xrotation Zrotation",
                                   "1 Xrotation", "Frames: 1\nFrame Time: .05\n1 2 3 4 5 6 7\n"));
  const std::string text = EncodeBvh(file.clip, file.convention);
  EXPECT_NE(text.find("CHANNELS 1 Xrotation"), std::string::npos);
  EXPECT_NE(text.find("CHANNELS 6 Yrotation Xrotation Zrotation Xposition Zposition Yposition"),
            std::string::npos);
  ExpectSame(Read(text).clip, file.clip, 1e-7);
}

TEST(BvhTest, ARotationThatFewChannelsCannotHoldGetsThree) {
  ClipFile file = Read(Trunk("3 Xposition Yposition Zposition", "1 Xrotation",
                             "Frames: 1\nFrame Time: .05\n0 0 0 7\n"));
  file.clip.rotation(0, 1) = math::FromRotationVector(Vec3(0.1, 0.2, 0.3));
  file.clip.rotation(0, 0) = math::FromRotationVector(Vec3(0, 0, 0.3));
  ExpectSame(Read(EncodeBvh(file.clip, file.convention)).clip, file.clip, 1e-7);
}

TEST(BvhTest, WritingAndReadingAgreesInEveryConvention) {
  const Clip clip = testing::SwingingClip(40, 120, 2.5);
  for (const double unit_m : {1.0, 0.01, 0.001, 0.0254, 0.0254 / 0.45}) {
    for (const UpAxis up : {UpAxis::kY, UpAxis::kZ}) {
      for (const bool turned : {false, true}) {
        SourceConvention convention{.unit_m = unit_m, .up = up};
        convention.rest_pose_turned = turned && up == UpAxis::kZ;
        const ClipFile file = Read(EncodeBvh(clip, convention), {.unit_m = unit_m, .up = up});
        EXPECT_EQ(file.convention.rest_pose_turned, convention.rest_pose_turned);
        ExpectSame(file.clip, clip, 1e-7);
      }
    }
  }
}

TEST(BvhTest, UnitAndUpAxisAreDetectedAndExplained) {
  const Clip clip = testing::SwingingClip(40);
  for (const double unit_m : {1.0, 0.01, 0.001, 0.0254, 0.0254 / 0.45}) {
    for (const bool turned : {false, true}) {
      SourceConvention convention{.unit_m = unit_m, .up = UpAxis::kZ, .rest_pose_turned = turned};
      const ClipFile file = Read(EncodeBvh(clip, convention));
      EXPECT_NEAR(file.convention.unit_m, unit_m, 1e-12);
      EXPECT_EQ(file.convention.up, UpAxis::kZ);
      EXPECT_EQ(file.convention.rest_pose_turned, turned);
      ASSERT_GE(file.convention.notes.size(), 3u);
      EXPECT_EQ(file.convention.notes[0].rfind("unit: ", 0), 0u);
      EXPECT_EQ(file.convention.notes[1].rfind("up: Z", 0), 0u);
      EXPECT_EQ(file.convention.notes[2].rfind("rate: 120 Hz", 0), 0u);
    }
  }
}

TEST(BvhTest, HintsOverrideWhatWouldBeDetected) {
  const std::string text = EncodeBvh(testing::SwingingClip(4));
  const ClipFile file = Read(text, {.unit_m = 0.02, .up = UpAxis::kZ, .frame_rate = 50});
  EXPECT_EQ(file.convention.unit_m, 0.02);
  EXPECT_EQ(file.convention.up, UpAxis::kZ);
  EXPECT_EQ(file.clip.frame_rate(), 50);
  EXPECT_EQ(base::ErrorReason(DecodeClip("x.bvh", text, {}, {.unit_m = -1}).status()), "BAD_HINT");
}

TEST(BvhTest, MovingRootChainIsFoldedIntoTheRoot) {
  const std::string text =
      "HIERARCHY\nROOT world {\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation "
      "Xrotation Yrotation\nJOINT hips {\nOFFSET 0 90 0\nCHANNELS 6 Xposition Yposition Zposition "
      "Zrotation Xrotation Yrotation\nJOINT left {\nOFFSET 50 0 0\nEnd Site {\nOFFSET 0 -80 "
      "0\n}\n}\n"
      "JOINT right {\nOFFSET -50 0 0\nEnd Site {\nOFFSET 0 -80 0\n}\n}\n}\n}\nMOTION\nFrames: 2\n"
      "Frame Time: 0.1\n10 0 0 0 0 90 0 100 5 0 0 0\n10 0 0 0 0 90 0 100 6 30 0 0\n";
  const ClipFile file = Read(text, {.unit_m = 0.01, .up = UpAxis::kY});
  ASSERT_EQ(file.clip.num_joints(), 3);
  EXPECT_EQ(file.clip.skeleton()->joint(0).name, "hips");
  // 90 degrees about Y turn the hips' +Z to +X.
  EXPECT_LT((file.clip.root_position(1) - Vec3(0.16, 1.0, 0)).norm(), 1e-9);
  const Quat expected = math::FromEuler(Vec3(0, 90, 0) * kRadians, math::kXYZ) *
                        math::FromRotationVector(Vec3(0, 0, 30 * kRadians));
  EXPECT_LT(math::GeodesicDistance(file.clip.rotation(1, 0), expected), 1e-9);
  const std::string written = EncodeBvh(file.clip, file.convention);
  ExpectSame(Read(written, {.unit_m = 0.01, .up = UpAxis::kY}).clip, file.clip, 1e-7);
}

TEST(BvhTest, ConstantPositionChannelsReplaceTheOffset) {
  const std::string two_arms =
      "HIERARCHY\nROOT hips {\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\nJOINT a {\n"
      "OFFSET 1 2 3\nCHANNELS 3 Xposition Yposition Zposition\n}\nJOINT b {\nOFFSET 0 90 "
      "0\nCHANNELS "
      "3 Xposition Yposition Zposition\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.1\n";
  const ClipFile file =
      Read(two_arms + "0 0 0 10 20 30 0 0 0\n1 1 1 10 20 30 0 0 0\n", {.unit_m = 1.0});
  EXPECT_EQ(file.clip.skeleton()->joint(1).offset, Vec3(10, 20, 30));
  EXPECT_EQ(file.clip.skeleton()->joint(2).offset, Vec3(0, 90, 0));  // all zero: OFFSET stands
}

TEST(BvhTest, MixedLineEndsTabsAndLatinLettersAreRead) {
  std::string text =
      Trunk("3 Xposition Yposition Zposition ", "3 Zrotation Xrotation Yrotation",
            "Frames:\t2\r\nFrame Time:\t0.0333333\n\n0 0 -0 1 2 3\r\n0 1e-014 +1 1 2 "
            "3 \n\r\n");
  text.replace(text.find("hips"), 4, "h\xfcpfte");
  const ClipFile file = Read(text);
  EXPECT_EQ(file.clip.skeleton()->joint(0).name, "h\xc3\xbcpfte");
  EXPECT_EQ(file.clip.num_frames(), 2);
  EXPECT_EQ(file.clip.frame_rate(), 30);
}

TEST(BvhTest, RatesAreTheUsualOnesThatFrameTimesRoundTo) {
  const auto rate = [](const std::string& time) {
    return Read(Trunk("3 Xposition Yposition Zposition", "1 Xrotation",
                      "Frames: 1\nFrame Time: " + time + "\n0 0 0 1\n"))
        .clip.frame_rate();
  };
  EXPECT_EQ(rate("0.0083333"), 120);
  EXPECT_EQ(rate(".00833"), 120);
  EXPECT_EQ(rate("0.016667"), 60);
  EXPECT_EQ(rate("0.0333333"), 30);
  EXPECT_NEAR(rate("0.041708333"), 23.976, 1e-4);
  EXPECT_EQ(rate("0.0142857"), 70);
}

TEST(BvhTest, HostileNamesAreWrittenSoThatTheyCanBeRead) {
  const auto skeleton = *Skeleton::Create({{"a{b}\nMOTION", -1, Vec3::Zero(), {}},
                                           {" ", 0, Vec3(0, 1, 0), {}},
                                           {"Bip01 L Thigh", 1, Vec3(0, 1, 0), {}}});
  const Clip clip = *Clip::Create("x", skeleton, 30, {Vec3::Zero()},
                                  {Quat::Identity(), Quat::Identity(), Quat::Identity()});
  const auto file = DecodeClip("x.bvh", EncodeBvh(clip));
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_EQ(file->clip.skeleton()->joint(2).name, "Bip01 L Thigh");
}

}  // namespace
}  // namespace poise::motion
