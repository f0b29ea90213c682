// Every real motion file is read, and its joints lie where independent programs put them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "core/motion/io/clip_file.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "tests/support/data_files.h"

namespace poise::motion {
namespace {

using math::Mat3;

using testing::DataFiles;
using testing::DataPath;

ClipFile Read(const std::string& below) {
  auto file = ReadClipFile(DataPath(below));
  EXPECT_TRUE(file.ok()) << file.status();
  return *std::move(file);
}

// World position of a joint, or, for `far_end`, of the end of its bone.
Vec3 Position(const Clip& clip, int frame, const std::string& joint, bool far_end = false) {
  const WorldPoses poses = ForwardKinematics(clip);
  const int index = clip.skeleton()->Find(joint).value();
  if (!far_end) return poses.position(frame, index);
  const auto children = clip.skeleton()->children(index);
  return poses.Point(frame, index,
                     children.empty() ? clip.skeleton()->joint(index).end_site.value()
                                      : clip.skeleton()->joint(children[0]).offset);
}

// Printed with four decimals.
void ExpectAt(const Vec3& position, const Vec3& expected, const std::string& what) {
  EXPECT_LT((position - expected).cwiseAbs().maxCoeff(), 0.5001e-4)
      << what << ": " << position.transpose() << ", expected " << expected.transpose();
}

void ExpectHuman(const std::string& folder, const std::vector<std::string>& endings,
                 size_t expected_files, double unit_m, UpAxis up, double rate) {
  size_t files = 0;
  for (const auto& path : DataFiles(folder, endings)) {
    if (path.filename() == "LICENSE") continue;
    const auto file = ReadClipFile(path);
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_NEAR(file->convention.unit_m, unit_m, 1e-9) << path << file->convention.notes[0];
    EXPECT_EQ(file->convention.up, up) << path << file->convention.notes[1];
    EXPECT_EQ(file->clip.frame_rate(), rate) << path;
    EXPECT_EQ(file->clip.name(), path.stem().string());
    ++files;
  }
  EXPECT_EQ(files, expected_files) << folder;
}

constexpr double kCmuUnit = 0.0254 / 0.45;

TEST(RealDataTest, EveryHdm05FileIsRead) {
  POISE_REQUIRE_DATA("hdm05");
  ExpectHuman("hdm05", {".amc"}, 226, kCmuUnit, UpAxis::kY, 120);
}

TEST(RealDataTest, EveryCmuFileIsRead) {
  POISE_REQUIRE_DATA("cmu");
  ExpectHuman("cmu", {".txt"}, 96, kCmuUnit, UpAxis::kY, 120);
}

TEST(RealDataTest, EveryBandaiFileIsRead) {
  POISE_REQUIRE_DATA("bandai");
  ExpectHuman("bandai", {".bvh"}, 64, 0.01, UpAxis::kY, 30);
}

// The steps of dance_spin, jog, backflip and so on differ, and those within roll.
TEST(RealDataTest, EveryDeepMimicFileIsRead) {
  POISE_REQUIRE_DATA("deepmimic");
  int files = 0, resampled = 0;
  for (const auto& path : DataFiles("deepmimic", {".txt"})) {
    const auto file = ReadClipFile(path);
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_EQ(file->convention.format, ClipFormat::kDeepMimic);
    resampled += file->convention.notes.back().find("resampled") != std::string::npos;
    ++files;
  }
  EXPECT_EQ(files, 20);
  EXPECT_EQ(resampled, 1);
  EXPECT_EQ(Read("deepmimic/humanoid3d_walk.txt").clip.num_frames(), 39);
  EXPECT_EQ(Read("deepmimic/humanoid3d_dance_spin.txt").clip.frame_rate(), 120);
}

TEST(RealDataTest, EveryFzjFileIsRead) {
  POISE_REQUIRE_DATA("fzj_push");
  ExpectHuman("fzj_push", {".bvh"}, 332, 0.001, UpAxis::kZ, 60);
}

TEST(RealDataTest, Hdm05BonesEndWhereTheReferenceSays) {
  POISE_REQUIRE_DATA("hdm05");
  const auto check = [](const std::string& below, int frame, Vec3 root, Vec3 head, Vec3 hand,
                        Vec3 toes) {
    const Clip clip = Read("hdm05/" + below).clip;
    ExpectAt(clip.root_position(frame), root, below + " root");
    ExpectAt(Position(clip, frame, "head", true), head, below + " head");
    ExpectAt(Position(clip, frame, "lhand", true), hand, below + " lhand");
    ExpectAt(Position(clip, frame, "ltoes", true), toes, below + " ltoes");
  };
  const std::string kick = "kickLFront1Reps/HDM_bd_kickLFront1Reps_001_120.amc";
  check(kick, 0, {-0.0952, 0.9548, -0.2067}, {-0.0923, 1.6189, -0.2291}, {-0.1546, 1.1067, -0.3985},
        {-0.1583, 0.0350, -0.2940});
  check(kick, 160, {-0.0895, 0.9305, -0.3949}, {-0.1527, 1.5913, -0.3252},
        {-0.1476, 1.2202, -0.6286}, {-0.1200, 0.0059, -0.4127});
  const std::string jog = "jogLeftCircle4StepsRstart/HDM_tr_jogLeftCircle4StepsRstart_014_120.amc";
  check(jog, 0, {-1.2923, 1.0426, -1.5509}, {-1.2002, 1.6964, -1.3639}, {-1.0079, 0.9065, -1.6880},
        {-1.2038, 0.0551, -1.4934});
  check(jog, 249, {1.3401, 0.9666, -0.3432}, {1.2885, 1.6285, -0.5189}, {1.3254, 0.8720, -0.6256},
        {1.5345, 0.0065, -0.1501});
}

TEST(RealDataTest, CmuJointsLieWhereTheReferenceSays) {
  POISE_REQUIRE_DATA("cmu");
  const ClipFile file = Read("cmu/test/walking/walking_1.txt");
  const Clip& clip = file.clip;
  EXPECT_EQ(clip.num_frames(), 359);
  const char* joints[] = {"Hips", "Head", "LeftToeBase", "LeftHand"};
  const Vec3 row_1[] = {{0.2484, 1.0100, -1.1909},
                        {0.2622, 1.4169, -1.1640},
                        {0.3070, 0.1177, -0.7469},
                        {0.4792, 0.8407, -1.1465}};
  const Vec3 row_358[] = {{0.2194, 0.9922, 2.6429},
                          {0.2178, 1.4000, 2.6570},
                          {0.2535, 0.0800, 2.3800},
                          {0.4927, 0.8711, 2.8135}};
  const double rounded = 0.056444 / kCmuUnit;  // the table was made with the unit so rounded
  for (int i = 0; i < 4; ++i) {
    ExpectAt(rounded * Position(clip, 1, joints[i]), row_1[i], joints[i]);
    ExpectAt(rounded * Position(clip, 358, joints[i]), row_358[i], joints[i]);
  }
  EXPECT_NE(file.convention.notes.back().find("T-pose"), std::string::npos);
}

TEST(RealDataTest, BandaiJointsLieWhereTheReferenceSays) {
  POISE_REQUIRE_DATA("bandai");
  const Clip clip = Read("bandai/dataset-1/dataset-1_kick_normal_001.bvh").clip;
  EXPECT_EQ(clip.num_frames(), 358);
  const char* joints[] = {"Hips", "Head", "Hand_L", "Foot_R"};
  const Vec3 frame_0[] = {{-0.0454, 0.8656, -0.0159},
                          {-0.0492, 1.3401, 0.0059},
                          {-0.0660, 1.2524, 0.2444},
                          {-0.1557, 0.1174, -0.2206}};
  const Vec3 frame_191[] = {{0.0554, 0.9170, 0.1991},
                            {0.1725, 1.3041, -0.0372},
                            {0.3144, 0.9857, 0.0751},
                            {-0.5226, 0.8780, 0.6553}};
  for (int i = 0; i < 4; ++i) {
    ExpectAt(Position(clip, 0, joints[i]), frame_0[i], joints[i]);
    ExpectAt(Position(clip, 191, joints[i]), frame_191[i], joints[i]);
  }
}

// joint_Root travels in two clips and stands still in the others: the body is the same.
TEST(RealDataTest, AllBandaiClipsHaveTheSameJointsWithTheHipsAsRoot) {
  POISE_REQUIRE_DATA("bandai");
  for (const auto& path : DataFiles("bandai", {".bvh"})) {
    const Clip clip = ReadClipFile(path)->clip;
    ASSERT_EQ(clip.skeleton()->joint(0).name, "Hips") << path;
    ASSERT_EQ(clip.num_joints(), 21) << path;
  }
  const Clip clip = Read("bandai/dataset-1/dataset-1_run_normal_001.bvh").clip;
  EXPECT_GT((clip.root_position(clip.num_frames() - 1) - clip.root_position(0)).norm(), 1.0);
}

TEST(RealDataTest, FzjPosesAgreeWithTheReleasedForwardKinematics) {
  POISE_REQUIRE_DATA("fzj_push/checks/fk_sample.csv");
  std::ifstream csv(DataPath("fzj_push/checks/fk_sample.csv"));
  std::string line, open_file;
  std::getline(csv, line);
  std::optional<Clip> clip;
  WorldPoses poses;
  int rows = 0;
  Mat3 file_from_poise;  // Y up to Z up
  file_from_poise << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  while (std::getline(csv, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    std::string file;
    int frame, joint;
    Vec3 position;
    Mat3 rotation;
    fields >> file >> frame >> joint >> position[0] >> position[1] >> position[2];
    for (int i = 0; i < 9; ++i) fields >> rotation(i / 3, i % 3);
    if (file != open_file) {
      clip = Read("fzj_push/" + file).clip;
      poses = ForwardKinematics(*clip);
      open_file = file;
    }
    const int index = clip->skeleton()->Find(fmt::format("joint_{}", joint)).value();
    const Vec3 found = file_from_poise * poses.position(frame, index) * 1000;
    EXPECT_LT((found - position).cwiseAbs().maxCoeff(), 1e-6) << line;
    const Mat3 turned = file_from_poise * poses.rotation(frame, index).toRotationMatrix() *
                        file_from_poise.transpose();
    EXPECT_LT((turned - rotation).cwiseAbs().maxCoeff(), 1e-9) << line;
    ++rows;
  }
  EXPECT_EQ(rows, 88);
}

// Largest differences between two clips [rad, m].
std::pair<double, double> Difference(const Clip& a, const Clip& b) {
  EXPECT_EQ(a.num_frames(), b.num_frames());
  EXPECT_TRUE(a.skeleton()->SameAs(*b.skeleton(), 1e-6));
  double angle = 0, distance = 0;
  for (int frame = 0; frame < a.num_frames(); ++frame) {
    distance = std::max(distance, (a.root_position(frame) - b.root_position(frame)).norm());
    for (int joint = 0; joint < a.num_joints(); ++joint) {
      angle = std::max(angle,
                       math::GeodesicDistance(a.rotation(frame, joint), b.rotation(frame, joint)));
    }
  }
  return {angle, distance};
}

TEST(RealDataTest, EveryFileSurvivesWritingAsBvh) {
  POISE_REQUIRE_DATA("fzj_push");
  POISE_REQUIRE_DATA("bandai");
  POISE_REQUIRE_DATA("hdm05");
  POISE_REQUIRE_DATA("cmu");
  std::vector<std::filesystem::path> paths;
  for (const char* folder : {"fzj_push", "bandai", "hdm05", "cmu/test"}) {
    const auto more = DataFiles(folder, {".bvh", ".amc", ".txt"});
    paths.insert(paths.end(), more.begin(), more.end());
  }
  for (const auto& path : paths) {
    if (path.string().find("splits") != std::string::npos) continue;
    const auto file = ReadClipFile(path);
    ASSERT_TRUE(file.ok()) << file.status();
    const std::string text = EncodeBvh(file->clip, file->convention);
    const auto again = DecodeClip("again.bvh", text);
    ASSERT_TRUE(again.ok()) << again.status();
    EXPECT_NEAR(again->convention.unit_m, file->convention.unit_m, 1e-9) << path;
    EXPECT_EQ(again->convention.up, file->convention.up) << path;
    EXPECT_EQ(again->convention.rest_pose_turned, file->convention.rest_pose_turned) << path;
    EXPECT_EQ(again->clip.frame_rate(), file->clip.frame_rate());
    const auto [angle, distance] = Difference(file->clip, again->clip);
    EXPECT_LT(angle, 1e-7) << path;
    EXPECT_LT(distance, 1e-7) << path;
  }
}

}  // namespace
}  // namespace poise::motion
