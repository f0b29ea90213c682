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

TEST(RealMirrorTest, EveryHdmActorFollowsTheRuleOfMotionAugBitForBit) {
  POISE_REQUIRE_DATA("hdm05/grabHighR");
  for (const auto& file : testing::DataFiles("hdm05/grabHighR", {".amc"})) {
    const Clip clip = ReadClipFile(file)->clip;
    const JointRoles roles = *JointRoles::Detect(*clip.skeleton());
    const std::vector<int> partners = *FindJointPairs(*clip.skeleton(), roles);
    const Clip mirrored = *Mirror(clip, roles);
    for (int j = 0; j < clip.num_joints(); ++j) {
      const Quat& q = clip.rotation(50, partners[j]);
      EXPECT_EQ(mirrored.rotation(50, j).coeffs(), Quat(q.w(), q.x(), -q.y(), -q.z()).coeffs())
          << file << " " << clip.skeleton()->joint(j).name;
    }
  }
}

// Limb bones of both clips point the same way in every frame, and the pelvis travels as far for its
// legs.
void ExpectSameMotion(const Clip& a, const JointRoles& roles_a, const Clip& b,
                      const JointRoles& roles_b) {
  const WorldPoses world_a = ForwardKinematics(a), world_b = ForwardKinematics(b);
  double worst = 0;
  for (int frame = 0; frame < a.num_frames(); ++frame) {
    for (const auto& [from, to] :
         {std::pair(kLeftHip, kLeftKnee), std::pair(kLeftKnee, kLeftAnkle),
          std::pair(kLeftAnkle, kLeftToe), std::pair(kLeftShoulder, kLeftElbow),
          std::pair(kLeftElbow, kLeftWrist), std::pair(kRightHip, kRightKnee),
          std::pair(kRightKnee, kRightAnkle), std::pair(kRightAnkle, kRightToe),
          std::pair(kRightShoulder, kRightElbow), std::pair(kRightElbow, kRightWrist)}) {
      const Vec3 u =
          world_a.position(frame, roles_a.joint(to)) - world_a.position(frame, roles_a.joint(from));
      const Vec3 v =
          world_b.position(frame, roles_b.joint(to)) - world_b.position(frame, roles_b.joint(from));
      worst = std::max(worst, std::atan2(u.cross(v).norm(), u.dot(v)));
    }
  }
  EXPECT_LT(worst, 1e-5);
  const auto travelled = [](const WorldPoses& world, int pelvis) {
    return Vec3(world.position(world.num_frames - 1, pelvis) - world.position(0, pelvis));
  };
  const double scale = LegLength(*b.skeleton(), roles_b) / LegLength(*a.skeleton(), roles_a);
  EXPECT_LT((travelled(world_b, roles_b.joint(kPelvis)) -
             scale * travelled(world_a, roles_a.joint(kPelvis)))
                .norm(),
            1e-9);
}

TEST_P(RealClipTest, RetargetsToEveryOtherBodyWithTheSameDirectionsOfLimbs) {
  POISE_REQUIRE_DATA(GetParam());
  const Clip clip = Read(GetParam());
  const JointRoles roles = *JointRoles::Detect(*clip.skeleton());
  for (const char* file : kFiles) {
    SCOPED_TRACE(file);
    POISE_REQUIRE_DATA(file);
    const Clip other = Read(file);
    const JointRoles other_roles = *JointRoles::Detect(*other.skeleton());
    // A motion of the target changes turns about bones only.
    for (const bool with_reference : {false, true}) {
      const auto out =
          Retarget(clip, roles, other.skeleton(), other_roles, {with_reference ? &other : nullptr});
      ASSERT_TRUE(out.ok()) << out.status();
      ExpectSameMotion(clip, roles, *out, other_roles);
    }
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
