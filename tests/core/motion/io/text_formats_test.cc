// ASF/AMC, CMU's rotation vectors and DeepMimic's JSON, on small files written here.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "core/motion/io/clip_file.h"
#include "core/motion/kinematics/forward_kinematics.h"

namespace poise::motion {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

const std::string kAsf =
    "# comment\r\n:version 1.10\r\n:units\r\n  mass 1.0\r\n  length 0.45\r\n  angle "
    "deg\r\n:root\r\n"
    "  order TX TY TZ RX RY RZ\r\n  axis XYZ\r\n  position 0 0 0\r\n  orientation 0 0 0\r\n"
    ":bonedata\r\n  begin\r\n    id 1\r\n    name thigh\r\n    direction 0 -1 0\r\n    length 7\r\n"
    "    axis 0 0 20 XYZ\r\n    dof rx rz\r\n    limits (-160.0 20.0)\r\n           (-70.0 "
    "70.0)\r\n"
    "  end\r\n  begin\r\n    id 2\r\n    name shank\r\n    direction 0 -1 7.6e-016\r\n"
    "    length 6\r\n    axis 0 0 0 XYZ\r\n  end\r\n:hierarchy\r\n  begin\r\n    root thigh\r\n"
    "    thigh shank\r\n  end\r\n";
const std::string kAmc =
    "#!OML:ASF F:\\M\xfcller.asf\r\n:FULLY-SPECIFIED\r\n:DEGREES\r\n1\nroot 1 2 3 0 90 0\r\n"
    "thigh 30 -2.9e-014\r\n2\nroot 1 2 3 0 2490 0\r\nthigh 390 0\r\n";

TEST(AmcTest, BonesBeginWhereTheirParentsEndAndTurnAboutTheirAxes) {
  const auto file = DecodeClip("kick_60.amc", kAmc, ClipFormat::kUnknown, {}, kAsf);
  ASSERT_TRUE(file.ok()) << file.status();
  const Clip& clip = file->clip;
  const double unit = 0.0254 / 0.45;
  ASSERT_EQ(clip.num_joints(), 3);
  EXPECT_EQ(clip.frame_rate(), 60);
  EXPECT_LT((clip.root_position(0) - unit * Vec3(1, 2, 3)).norm(), 1e-12);
  EXPECT_LT((clip.skeleton()->joint(2).offset - unit * Vec3(0, -7, 0)).norm(), 1e-12);
  EXPECT_LT((*clip.skeleton()->joint(2).end_site - unit * Vec3(0, -6, 0)).norm(), 1e-12);
  const Quat axis = math::FromRotationVector(Vec3(0, 0, 20 * kRadians));
  const Quat bent = axis * math::FromRotationVector(Vec3(30 * kRadians, 0, 0)) * axis.conjugate();
  for (const int frame : {0, 1}) {  // the second is the first, unwrapped over many turns
    EXPECT_LT(math::GeodesicDistance(clip.rotation(frame, 1), bent), 1e-9);
    EXPECT_EQ(clip.rotation(frame, 2).w(), 1);
  }
  EXPECT_LT(math::GeodesicDistance(clip.rotation(1, 0),
                                   math::FromRotationVector(Vec3(0, -30 * kRadians, 0))),
            1e-9);
}

TEST(AmcTest, FindsItsSkeletonByTheLongestNameBesideItOrInASkeletonsFolder) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(::testing::TempDir()) / "poise_amc_test";
  fs::remove_all(folder);
  fs::create_directories(folder / "kick");
  fs::create_directories(folder / "skeletons");
  const auto write = [](const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
  };
  write(folder / "kick" / "HDM_bd_kick_001_120.amc", kAmc);
  const fs::path amc = folder / "kick" / "HDM_bd_kick_001_120.amc";
  EXPECT_EQ(base::ErrorReason(ReadClipFile(amc).status()), "MISSING_SKELETON");
  write(folder / "skeletons" / "HDM_b.asf", "garbage");
  write(folder / "skeletons" / "HDM_bd.asf", kAsf);
  EXPECT_TRUE(ReadClipFile(amc).ok()) << ReadClipFile(amc).status();
  write(folder / "kick" / "HDM.asf", "garbage");
  EXPECT_EQ(base::ErrorReason(ReadClipFile(amc).status()), "MALFORMED_ASF");
  EXPECT_TRUE(ReadClipFile(amc, {}, folder / "skeletons" / "HDM_bd.asf").ok());
  EXPECT_EQ(base::ErrorReason(ReadClipFile(folder / "none.amc").status()), "FILE_NOT_FOUND");
  EXPECT_EQ(base::ErrorReason(ReadClipFile(folder).status()), "FILE_NOT_FOUND");
  EXPECT_EQ(base::ErrorReason(
                WriteBvhFile(folder / "no" / "x.bvh",
                             ReadClipFile(amc, {}, folder / "skeletons" / "HDM_bd.asf")->clip)),
            "CANNOT_WRITE");
}

std::string CmuRow(double left_arm_turn) {
  std::string row = "1,2,3";
  for (int i = 3; i < 117; ++i) row += i == 66 ? fmt::format(",{}", left_arm_turn) : ",-0";
  return row + "\n";
}

TEST(CmuTextTest, VectorsAreThoseOfTheTransposedMatrices) {
  const auto file = DecodeClip("walk.txt", CmuRow(1.5) + CmuRow(0.25));
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_EQ(file->convention.format, ClipFormat::kCmuText);
  const Clip& clip = file->clip;
  ASSERT_EQ(clip.num_joints(), 31);
  const int arm = clip.skeleton()->Find("LeftArm").value();
  EXPECT_LT((math::ToRotationVector(clip.rotation(1, arm)) - Vec3(-0.25, 0, 0)).norm(), 1e-12);
  EXPECT_NEAR(clip.root_position(0).z(), 3 * 0.056444, 1e-5);
  EXPECT_EQ(clip.frame_rate(), 120);
  EXPECT_NE(file->convention.notes.back().find("T-pose"), std::string::npos);
  EXPECT_EQ(
      DecodeClip("walk.txt", CmuRow(0.2) + CmuRow(0.25))->convention.notes.back().find("T-pose"),
      std::string::npos);
}

// A frame in which only the right knee is bent and the root stands at x.
std::string DeepMimicFrame(double duration, double x, double knee, double w = 1) {
  return fmt::format(
      "[{}, {},0.9,0, {},0,0,0, 1,0,0,0, 1,0,0,0, 1,0,0,0, {}, 1,0,0,0, 1,0,0,0, 0, 1,0,0,0, 0, "
      "1,0,0,0, 1,0,0,0, 0]",
      duration, x, w, knee);
}

TEST(DeepMimicTest, HingesTurnAboutZAndQuaternionsAreNormalised) {
  const auto file = DecodeClip("walk.txt", "{\"Loop\": \"wrap\", \"Frames\": [" +
                                               DeepMimicFrame(0.033332, 0, -1, 0.8) + "," +
                                               DeepMimicFrame(0, 1, -1) + "]}");
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_EQ(ClipFormatName(file->convention.format), std::string("deepmimic_json"));
  EXPECT_EQ(file->clip.frame_rate(), 30);
  const int knee = file->clip.skeleton()->Find("right_knee").value();
  EXPECT_LT((math::ToRotationVector(file->clip.rotation(0, knee)) - Vec3(0, 0, -1)).norm(), 1e-9);
  EXPECT_NE(file->convention.notes[3].find("normalised"), std::string::npos);
}

TEST(DeepMimicTest, VaryingDurationsAreResampledToTheMostCommonStep) {
  const auto file = DecodeClip(
      "roll.txt", "{\"Frames\": [" + DeepMimicFrame(0.05, 0, 0) + "," + DeepMimicFrame(0.05, 1, 0) +
                      "," + DeepMimicFrame(0.1, 2, 0) + "," + DeepMimicFrame(0, 4, -1) + "]}");
  ASSERT_TRUE(file.ok()) << file.status();
  ASSERT_EQ(file->clip.num_frames(), 5);
  EXPECT_EQ(file->clip.frame_rate(), 20);
  for (int frame = 0; frame < 5; ++frame)
    EXPECT_NEAR(file->clip.root_position(frame).x(), frame, 1e-9);
  EXPECT_NE(file->convention.notes.back().find("resampled"), std::string::npos);
}

TEST(ClipFormatTest, NamesAreReadBackAndUnknownOnesRefused) {
  for (const auto format : {ClipFormat::kBvh, ClipFormat::kAmc, ClipFormat::kNpz,
                            ClipFormat::kCmuText, ClipFormat::kDeepMimic, ClipFormat::kUnknown}) {
    EXPECT_EQ(*ParseClipFormat(ClipFormatName(format)), format);
  }
  EXPECT_EQ(base::ErrorReason(ParseClipFormat("fbx").status()), "UNKNOWN_FORMAT");
}

}  // namespace
}  // namespace poise::motion
