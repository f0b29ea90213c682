#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/motion/editing/mirror.h"
#include "core/motion/editing/reduce.h"
#include "core/motion/editing/retarget.h"
#include "core/motion/io/clip_file.h"
#include "core/motion/joint_pairs.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "core/motion/rest_pose.h"
#include "tests/support/data_files.h"

namespace poise::motion {
namespace {

using enum JointRole;

// One clip of each kind of body.
const char* const kFiles[] = {
    "hdm05/kickLFront1Reps/HDM_bd_kickLFront1Reps_001_120.amc",
    "hdm05/jogLeftCircle4StepsRstart/HDM_tr_jogLeftCircle4StepsRstart_014_120.amc",
    "cmu/test/walking/walking_1.txt", "bandai/dataset-1/dataset-1_kick_normal_001.bvh",
    "fzj_push/single/X09/Tue_03_p_03_m_X-09.bvh"};

Clip Read(const std::string& file) { return ReadClipFile(testing::DataPath(file))->clip; }

// How far the bones of one side are from mirror images of the other's (in whichever coordinate
// plane or point fits best), added up along the longest chain [m]: the error that a mirror may
// have.
double Asymmetry(const Skeleton& skeleton, const std::vector<int>& partners) {
  const Vec3 mirrors[] = {{-1, 1, 1}, {1, -1, 1}, {1, 1, -1}, {-1, -1, -1}};
  std::vector<double> sum(skeleton.num_joints(), 0);
  for (int j = 1; j < skeleton.num_joints(); ++j) {
    const Vec3 &bone = skeleton.joint(j).offset, &image = skeleton.joint(partners[j]).offset;
    double residual = HUGE_VAL;
    for (const Vec3& mirror : mirrors) {
      residual = std::min(residual, (mirror.cwiseProduct(bone) - image).norm());
    }
    sum[j] = sum[skeleton.parent(j)] + residual;
  }
  return *std::max_element(sum.begin(), sum.end());
}

class RealClipTest : public ::testing::TestWithParam<const char*> {};

TEST_P(RealClipTest, MirrorsToItsMirrorImageAndBack) {
  POISE_REQUIRE_DATA(GetParam());
  const Clip clip = Read(GetParam());
  const JointRoles roles = *JointRoles::Detect(*clip.skeleton());
  const std::vector<int> partners = *FindJointPairs(*clip.skeleton(), roles);
  const Clip mirrored = *Mirror(clip, roles);
  const Clip twice = *Mirror(mirrored, roles);
  const WorldPoses before = ForwardKinematics(clip), after = ForwardKinematics(mirrored);
  double worst = 0, worst_turn = 0;
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    for (int j = 0; j < clip.num_joints(); ++j) {
      Vec3 image = before.position(frame, partners[j]);
      image.x() *= -1;
      worst = std::max(worst, (after.position(frame, j) - image).norm());
      worst_turn = std::max(
          worst_turn, math::GeodesicDistance(twice.rotation(frame, j), clip.rotation(frame, j)));
    }
  }
  const double allowed = Asymmetry(*clip.skeleton(), partners);
  std::printf("mirror image within %.4f m, bodies allow %.4f m\n", worst, allowed);
  EXPECT_LE(worst, allowed + 1e-9);
  EXPECT_LT(worst_turn, 1e-9);
}

TEST_P(RealClipTest, KeepsTheDirectionsOfLimbsOnEveryOtherBody) {
  POISE_REQUIRE_DATA(GetParam());
  const Clip clip = Read(GetParam());
  const JointRoles roles = *JointRoles::Detect(*clip.skeleton());
  const WorldPoses before = ForwardKinematics(clip);
  for (const char* file : kFiles) {
    POISE_REQUIRE_DATA(file);
    const Clip other = Read(file);
    const JointRoles other_roles = *JointRoles::Detect(*other.skeleton());
    const auto out = Retarget(clip, roles, other.skeleton(), other_roles, {&other});
    ASSERT_TRUE(out.ok()) << file << ": " << out.status();
    const WorldPoses after = ForwardKinematics(*out);
    double worst = 0;
    for (int frame = 0; frame < clip.num_frames(); ++frame) {
      for (const auto& [from, to] :
           {std::pair(kLeftHip, kLeftKnee), std::pair(kLeftKnee, kLeftAnkle),
            std::pair(kLeftAnkle, kLeftToe), std::pair(kLeftShoulder, kLeftElbow),
            std::pair(kLeftElbow, kLeftWrist), std::pair(kRightHip, kRightKnee),
            std::pair(kRightKnee, kRightAnkle), std::pair(kRightAnkle, kRightToe),
            std::pair(kRightShoulder, kRightElbow), std::pair(kRightElbow, kRightWrist)}) {
        const Vec3 u =
            before.position(frame, roles.joint(to)) - before.position(frame, roles.joint(from));
        const Vec3 v = after.position(frame, other_roles.joint(to)) -
                       after.position(frame, other_roles.joint(from));
        worst = std::max(worst, std::atan2(u.cross(v).norm(), u.dot(v)));
      }
    }
    const double scale =
        LegLength(*other.skeleton(), other_roles) / LegLength(*clip.skeleton(), roles);
    const Vec3 travelled = after.position(clip.num_frames() - 1, other_roles.joint(kPelvis)) -
                           after.position(0, other_roles.joint(kPelvis));
    const Vec3 expected = scale * (before.position(clip.num_frames() - 1, roles.joint(kPelvis)) -
                                   before.position(0, roles.joint(kPelvis)));
    EXPECT_LT(worst, 1e-5) << file;
    EXPECT_LT((travelled - expected).norm(), 1e-9) << file;
  }
}

TEST_P(RealClipTest, ReducesToSixteenJointsWithKeptWorldRotations) {
  POISE_REQUIRE_DATA(GetParam());
  const Clip clip = Read(GetParam());
  const JointRoles roles = *JointRoles::Detect(*clip.skeleton());
  const Clip reduced = *ReduceToRoles(clip, roles, ReductionMode::kComposed);
  const WorldPoses before = ForwardKinematics(clip), after = ForwardKinematics(reduced);
  for (int i = 0; i < kNumRequiredRoles; ++i) {
    const int joint = roles.joint(static_cast<JointRole>(i));
    EXPECT_LT(math::GeodesicDistance(after.rotation(20, i), before.rotation(20, joint)), 1e-7);
  }
}

INSTANTIATE_TEST_SUITE_P(EachBody, RealClipTest, ::testing::ValuesIn(kFiles));

}  // namespace
}  // namespace poise::motion
