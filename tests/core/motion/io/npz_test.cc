#include <gtest/gtest.h>

#include <numbers>

#include "core/motion/io/clip_file.h"
#include "core/motion/joint_roles.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "tests/core/motion/io/npz_bytes.h"

namespace poise::motion {
namespace {

using testing::Bytes;
using testing::Npy;
using testing::Packing;
using testing::Zip;

// Two frames of SMPL-H (156 numbers): upright in a world with Z up, then a bent left knee.
std::vector<double> Poses() {
  std::vector<double> poses(2 * 156, 0.0);
  for (const int frame : {0, 1}) poses[frame * 156] = std::numbers::pi / 2;
  poses[156 + 3 * 4] = 0.5;
  return poses;
}
const std::vector<double> kTrans = {1, 2, 0.95, 1, 2.1, 0.96};

std::vector<testing::ZipEntry> Entries() {
  return {{"poses.npy", Npy("<f8", "(2, 156)", Bytes(Poses()))},
          {"trans.npy", Npy("<f8", "(2, 3)", Bytes(kTrans))},
          {"gender.npy", Npy("<U4", "()", std::string(16, 'x'))},
          {"mocap_framerate.npy", Npy("<f8", "()", Bytes(std::vector<double>{120}))}};
}

void ExpectTheClip(const std::string& bytes) {
  const auto file = DecodeClip("stand.npz", bytes);
  ASSERT_TRUE(file.ok()) << file.status();
  const Clip& clip = file->clip;
  EXPECT_EQ(clip.name(), "stand");
  EXPECT_EQ(clip.frame_rate(), 120);
  ASSERT_EQ(clip.num_frames(), 2);
  ASSERT_EQ(clip.num_joints(), 22);
  EXPECT_EQ(file->convention.up, UpAxis::kZ);
  EXPECT_FALSE(file->convention.rest_pose_turned);
  EXPECT_LT((clip.root_position(0) - Vec3(1, 0.95, -2)).norm(), 1e-6);
  EXPECT_LT(math::GeodesicDistance(clip.rotation(0, 0), Quat::Identity()), 1e-6);
  const int knee = clip.skeleton()->Find("left_knee").value();
  EXPECT_LT((math::ToRotationVector(clip.rotation(1, knee)) - Vec3(0.5, 0, 0)).norm(), 1e-6);
  EXPECT_TRUE(JointRoles::Detect(*clip.skeleton())->missing().empty());
}

TEST(NpzTest, StoredDeflatedAndZip64ArchivesHoldTheSameClip) {
  for (const Packing packing : {Packing::kStored, Packing::kDeflated, Packing::kStoredZip64}) {
    ExpectTheClip(Zip(Entries(), packing));
  }
}

TEST(NpzTest, EveryNumPyVersionOrderAndNumberTypeHoldsTheSameClip) {
  for (const int version : {1, 2, 3}) {
    auto entries = Entries();
    entries[0].data = Npy("<f8", "(2, 156)", Bytes(Poses()), version);
    ExpectTheClip(Zip(entries, Packing::kStored));
  }
  auto entries = Entries();
  const std::vector<double> poses = Poses();
  std::vector<float> columns;
  for (int column = 0; column < 156; ++column) {
    for (int row = 0; row < 2; ++row)
      columns.push_back(static_cast<float>(poses[row * 156 + column]));
  }
  entries[0].data = Npy("<f4", "(2, 156)", Bytes(columns), 1, true);
  entries[3] = {"mocap_frame_rate.npy", Npy("<i8", "()", Bytes(std::vector<int64_t>{120}))};
  ExpectTheClip(Zip(entries, Packing::kDeflated));
}

TEST(NpzTest, TheDefaultBodyStandsOnItsFeetAtAHumansHeight) {
  const Clip clip = DecodeClip("stand.npz", Zip(Entries(), Packing::kStored))->clip;
  const WorldPoses poses = ForwardKinematics(clip);
  const auto height = [&](const char* joint) {
    return poses.position(0, clip.skeleton()->Find(joint).value()).y();
  };
  EXPECT_NEAR(height("left_ankle"), 0.06, 0.03);
  EXPECT_NEAR(height("head") + 0.18 - height("left_foot"), 1.70, 0.03);
  EXPECT_GT(poses.position(0, clip.skeleton()->Find("left_wrist").value()).x(),
            clip.root_position(0).x());
}

TEST(NpzTest, ABvhWrittenFromItIsReadBackWithZUp) {
  const ClipFile file = *DecodeClip("stand.npz", Zip(Entries(), Packing::kStored));
  const auto again = DecodeClip("stand.bvh", EncodeBvh(file.clip, file.convention));
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_EQ(again->convention.up, UpAxis::kZ);
  EXPECT_EQ(again->convention.unit_m, 1.0);
  for (int joint = 0; joint < file.clip.num_joints(); ++joint) {
    const std::string& name = file.clip.skeleton()->joint(joint).name;
    const int there = again->clip.skeleton()->Find(name).value();
    EXPECT_LT(math::GeodesicDistance(again->clip.rotation(1, there), file.clip.rotation(1, joint)),
              1e-7);
  }
}

}  // namespace
}  // namespace poise::motion
