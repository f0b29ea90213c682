#include "core/motion/editing/reduce.h"

#include <gtest/gtest.h>

#include "core/motion/kinematics/forward_kinematics.h"
#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

class ReduceTest : public ::testing::Test {
 protected:
  const Clip clip_ = testing::SwingingClip(20, 30, 0.6);
  const JointRoles roles_ = *JointRoles::Detect(*clip_.skeleton());
};

TEST_F(ReduceTest, KeepsTheSixteenJointsInTheirOrder) {
  const Clip reduced = *ReduceToRoles(clip_, roles_, ReductionMode::kReference);
  const JointRoles roles = *JointRoles::Detect(*reduced.skeleton());
  ASSERT_EQ(reduced.num_joints(), kNumRequiredRoles);
  // MotionAug sec. 1.6, column "reduced parent".
  const int parents[] = {-1, 0, 1, 2, 0, 4, 5, 2, 7, 8, 0, 10, 11, 2, 13, 14};
  for (int i = 0; i < kNumRequiredRoles; ++i) {
    EXPECT_EQ(roles.joint(static_cast<JointRole>(i)), i);
    EXPECT_EQ(reduced.skeleton()->parent(i), parents[i]);
  }
  const Joint& shoulder = reduced.skeleton()->joint(13);
  EXPECT_LT((shoulder.offset - Vec3(0.18, 0.18, 0)).norm(), 1e-12);  // collar's and its own
  EXPECT_EQ(*reduced.skeleton()->joint(12).end_site, Vec3(0, -0.06, 0.14));
  EXPECT_FALSE(reduced.skeleton()->joint(11).end_site.has_value());
}

TEST_F(ReduceTest, ReferenceKeepsLocalRotationsAndLosesThoseBetween) {
  const Clip reduced = *ReduceToRoles(clip_, roles_, ReductionMode::kReference);
  for (int i = 0; i < kNumRequiredRoles; ++i) {
    const int joint = roles_.joint(static_cast<JointRole>(i));
    EXPECT_EQ(reduced.rotation(9, i).coeffs(), clip_.rotation(9, joint).coeffs());
  }
}

TEST_F(ReduceTest, ComposedKeepsWorldRotationsOfKeptJoints) {
  const Clip reduced = *ReduceToRoles(clip_, roles_, ReductionMode::kComposed);
  const WorldPoses before = ForwardKinematics(clip_), after = ForwardKinematics(reduced);
  for (int frame = 0; frame < clip_.num_frames(); ++frame) {
    for (int i = 0; i < kNumRequiredRoles; ++i) {
      const int joint = roles_.joint(static_cast<JointRole>(i));
      EXPECT_LT(math::GeodesicDistance(after.rotation(frame, i), before.rotation(frame, joint)),
                1e-7);
    }
    // No joint is left out between pelvis and feet: positions are the same.
    for (const JointRole role : {JointRole::kLeftAnkle, JointRole::kRightAnkle}) {
      EXPECT_LT((after.position(frame, static_cast<int>(role)) -
                 before.position(frame, roles_.joint(role)))
                    .norm(),
                1e-12);
    }
  }
}

TEST_F(ReduceTest, APelvisBelowTheRootBecomesTheRootWhereItIsInTheWorld) {
  std::vector<Joint> joints = {{"origin", -1, Vec3::Zero(), {}}};
  for (Joint joint : clip_.skeleton()->joints()) {
    if (joint.parent < 0) joint.offset = Vec3(0, 0.9, 0);
    ++joint.parent;
    joints.push_back(joint);
  }
  std::vector<Vec3> positions(3, Vec3(1, 0, 2));
  std::vector<Quat> rotations(3 * joints.size(), Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX())));
  const Clip clip =
      *Clip::Create("below", *Skeleton::Create(joints), 30, std::move(positions), rotations);
  const JointRoles roles = *JointRoles::Detect(*clip.skeleton());
  const WorldPoses world = ForwardKinematics(clip);
  for (const ReductionMode mode : {ReductionMode::kReference, ReductionMode::kComposed}) {
    const Clip reduced = *ReduceToRoles(clip, roles, mode);
    EXPECT_EQ(reduced.root_position(1), world.position(1, 1));
    EXPECT_LT(math::GeodesicDistance(reduced.rotation(1, 0), world.rotation(1, 1)), 1e-12);
  }
}

TEST_F(ReduceTest, MissingRolesAndTangledHierarchiesAreRefused) {
  std::vector<Joint> joints = clip_.skeleton()->joints();
  joints[5].name = "limb";
  const Clip limb = *Clip::Create("limb", *Skeleton::Create(joints), 30, {Vec3(0, 1, 0)},
                                  std::vector<Quat>(joints.size(), Quat::Identity()));
  EXPECT_EQ(base::ErrorReason(
                ReduceToRoles(limb, *JointRoles::Detect(*limb.skeleton()), ReductionMode::kComposed)
                    .status()),
            "MISSING_ROLES");
  const JointRoles tangled = *JointRoles::Detect(
      *clip_.skeleton(), {{"right_hip", "right_knee"}, {"right_knee", "right_hip"}});
  EXPECT_EQ(base::ErrorReason(ReduceToRoles(clip_, tangled, ReductionMode::kComposed).status()),
            "UNUSUAL_HIERARCHY");
}

TEST_F(ReduceTest, ExpandingAnEditedReductionGivesItsWorldRotationsBack) {
  Clip edited = *ReduceToRoles(clip_, roles_, ReductionMode::kComposed);
  EXPECT_LT((ForwardKinematics(*ExpandFromRoles(edited, clip_, roles_)).position(7, 5) -
             ForwardKinematics(clip_).position(7, 5))
                .norm(),
            1e-9);
  for (int frame = 0; frame < edited.num_frames(); ++frame) {
    edited.root_position(frame) += Vec3(0.1, 0, 0.2);
    for (int i = 0; i < kNumRequiredRoles; ++i) {
      edited.rotation(frame, i) =
          edited.rotation(frame, i) * math::FromRotationVector(Vec3(0.02 * i, 0.1, -0.05));
    }
  }
  const Clip expanded = *ExpandFromRoles(edited, clip_, roles_);
  const Clip again = *ReduceToRoles(expanded, roles_, ReductionMode::kComposed);
  for (int frame = 0; frame < edited.num_frames(); ++frame) {
    EXPECT_LT((again.root_position(frame) - edited.root_position(frame)).norm(), 1e-9);
    for (int i = 0; i < kNumRequiredRoles; ++i) {
      EXPECT_LT(math::GeodesicDistance(again.rotation(frame, i), edited.rotation(frame, i)), 1e-7);
    }
  }
  EXPECT_EQ(base::ErrorReason(ExpandFromRoles(clip_, clip_, roles_).status()), "WRONG_SHAPE");
}

}  // namespace
}  // namespace poise::motion
