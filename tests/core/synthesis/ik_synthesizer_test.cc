#include "core/synthesis/ik/ik_synthesizer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/motion/kinematics/forward_kinematics.h"
#include "tests/support/test_clips.h"

namespace poise::synthesis {
namespace {

using motion::Clip;
using motion::JointRole;
using motion::JointRoles;
using motion::Vec3;

JointRoles RolesOf(const Clip& clip) { return *JointRoles::Detect(*clip.skeleton()); }

IkSynthesizer Make(const std::string& action_class, const std::string& preset = "recommended",
                   const base::Overrides& overrides = {}) {
  const ActionClass found = *FindActionClass(action_class);
  IkConfig config = *IkConfig::FromPreset(preset, found);
  EXPECT_TRUE(base::ApplyOverrides(overrides, config.Fields()).ok());
  return IkSynthesizer(found, config);
}

Draft SampleOne(const IkSynthesizer& synthesizer, const Clip& clip, uint64_t seed) {
  const Draft source{clip, std::nullopt};
  const auto bound = synthesizer.Bind(source, RolesOf(clip));
  EXPECT_TRUE(bound.ok()) << bound.status();
  base::Random random(seed);
  return *(*bound)->Sample(random, {});
}

// The distance that the joint really has from the target at the keyframe.
double MeasuredError(const Draft& draft) {
  const auto poses = motion::ForwardKinematics(draft.clip);
  const int joint = RolesOf(draft.clip).joint(draft.ik->end_effector);
  return (poses.position(draft.ik->keyframe, joint) - draft.ik->target).norm();
}

bool SameBits(const motion::Quat& a, const motion::Quat& b) { return a.coeffs() == b.coeffs(); }

class IkSynthesizerTest : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Presets, IkSynthesizerTest, ::testing::Values("recommended", "paper"),
                         [](const auto& info) { return info.param; });

TEST_P(IkSynthesizerTest, EveryClassMeetsReachableTargets) {
  const Clip clip = testing::SwingingClip(240);
  for (const ActionClass& action_class : ActionClasses()) {
    int reachable = 0;
    for (uint64_t seed = 0; seed < 40; ++seed) {
      const Draft draft = SampleOne(Make(action_class.name, GetParam()), clip, seed);
      EXPECT_NEAR(MeasuredError(draft), draft.ik->reached_error_m, 1e-9);
      if (draft.ik->reachable) {
        EXPECT_LT(draft.ik->reached_error_m, 1e-3) << action_class.name << " seed " << seed;
        ++reachable;
      }
    }
    EXPECT_GT(reachable, 0) << action_class.name;
  }
}

TEST_P(IkSynthesizerTest, OnlyTheLimbIsTouchedAndItsBonesKeepTheirLengths) {
  const Clip clip = testing::SwingingClip(240);
  const JointRoles roles = RolesOf(clip);
  const auto before = motion::ForwardKinematics(clip);
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const Draft draft = SampleOne(Make("kick", GetParam()), clip, seed);
    const auto after = motion::ForwardKinematics(draft.clip);
    const bool left = draft.ik->end_effector == JointRole::kLeftAnkle;
    const int hip = roles.joint(left ? JointRole::kLeftHip : JointRole::kRightHip);
    for (int frame = 0; frame < clip.num_frames(); ++frame) {
      EXPECT_EQ(draft.clip.root_position(frame), clip.root_position(frame));
      for (int joint = 0; joint < clip.num_joints(); ++joint) {
        const bool limb = joint >= hip && joint <= hip + 2;
        if (!limb) {
          EXPECT_TRUE(SameBits(draft.clip.rotation(frame, joint), clip.rotation(frame, joint)));
        }
        EXPECT_NEAR(draft.clip.rotation(frame, joint).norm(), 1, 1e-12);
        const int parent = clip.skeleton()->parent(joint);
        if (parent < 0) continue;
        EXPECT_NEAR((after.position(frame, joint) - after.position(frame, parent)).norm(),
                    (before.position(frame, joint) - before.position(frame, parent)).norm(), 1e-9);
      }
      // The foot keeps its orientation in the world.
      EXPECT_LT(
          math::GeodesicDistance(after.rotation(frame, hip + 2), before.rotation(frame, hip + 2)),
          1e-7);
    }
  }
}

TEST_P(IkSynthesizerTest, FactorsOfOneAndNoAngleGiveTheOriginalMotion) {
  const Clip clip = testing::SwingingClip(240);
  const Draft draft = SampleOne(Make("kick", GetParam(),
                                     {{"radius_low", "1"},
                                      {"radius_high", "1"},
                                      {"height_low", "1"},
                                      {"height_high", "1"},
                                      {"angle", "0"}}),
                                clip, 1);
  const auto before = motion::ForwardKinematics(clip),
             after = motion::ForwardKinematics(draft.clip);
  for (size_t i = 0; i < before.positions.size(); ++i) {
    EXPECT_LT((before.positions[i] - after.positions[i]).norm(), 1e-6);
  }
}

TEST(IkSynthesizerConfigTest, TheWindowLeavesFramesOutsideItAlone) {
  const Clip clip = testing::SwingingClip(240);
  const Draft draft = SampleOne(Make("kick"), clip, 3);
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    if (std::abs(frame - draft.ik->keyframe) < 0.4 * 120) continue;
    for (int joint = 0; joint < clip.num_joints(); ++joint) {
      EXPECT_TRUE(SameBits(draft.clip.rotation(frame, joint), clip.rotation(frame, joint)));
    }
  }
}

TEST(IkSynthesizerConfigTest, TheRampReachesBothEndsWithNoDisplacement) {
  const Clip clip = testing::SwingingClip(200);
  const base::Overrides easy = {{"keyframe", "80"}, {"radius_high", "0.9"}, {"height_low", "1.1"}};
  const Draft draft = SampleOne(Make("kick", "paper", easy), clip, 3);
  const JointRoles roles = RolesOf(clip);
  const auto before = motion::ForwardKinematics(clip),
             after = motion::ForwardKinematics(draft.clip);
  const int end = roles.joint(draft.ik->end_effector);
  const Vec3 full = after.position(80, end) - before.position(80, end);
  ASSERT_TRUE(draft.ik->reachable);
  for (const int frame : {0, 20, 40, 60, 80, 110, 140, 199}) {
    const double weight = frame <= 80 ? frame / 80.0 : (199.0 - frame) / (199 - 80);
    EXPECT_LT((after.position(frame, end) - before.position(frame, end) - weight * full).norm(),
              5e-4)
        << frame;
  }
}

TEST(IkSynthesizerConfigTest, AnEndEffectorAndAKeyframeByHandWin) {
  const Clip clip = testing::SwingingClip(240);
  const Draft draft = SampleOne(
      Make("kick", "recommended", {{"end_effector", "left_wrist"}, {"keyframe", "33"}}), clip, 1);
  EXPECT_EQ(draft.ik->end_effector, JointRole::kLeftWrist);
  EXPECT_EQ(draft.ik->keyframe, 33);
}

TEST(IkSynthesizerConfigTest, TheHingeLimitKeepsTheKneeFromFoldingFurther) {
  const Clip clip = testing::SwingingClip(240);
  const JointRoles roles = RolesOf(clip);
  // The ankle is asked up to the hip's height, close to the hip.
  const base::Overrides near = {{"radius_low", "0.3"},   {"radius_high", "0.3"},
                                {"height_low", "4"},     {"height_high", "4"},
                                {"hinge_limit", "true"}, {"max_flexion", "2"}};
  const Draft draft = SampleOne(Make("kick", "recommended", near), clip, 1);
  const auto poses = motion::ForwardKinematics(draft.clip);
  const bool left = draft.ik->end_effector == JointRole::kLeftAnkle;
  const int hip = roles.joint(left ? JointRole::kLeftHip : JointRole::kRightHip);
  const int frame = draft.ik->keyframe;
  const Vec3 thigh = poses.position(frame, hip + 1) - poses.position(frame, hip);
  const Vec3 shank = poses.position(frame, hip + 2) - poses.position(frame, hip + 1);
  const double flexion = std::acos(thigh.normalized().dot(shank.normalized()));
  EXPECT_LE(flexion, 2 + 1e-6);
}

TEST(IkSynthesizerConfigTest, AStraightLegBendsAtTheKneeForwards) {
  // Standing still: both legs hang straight down from the hips.
  const auto skeleton = testing::Biped();
  const int frames = 120;
  const Clip clip =
      *Clip::Create("stand", skeleton, 120, std::vector<Vec3>(frames, Vec3(0, 0.99, 0)),
                    std::vector<motion::Quat>(static_cast<size_t>(frames) * skeleton->num_joints(),
                                              motion::Quat::Identity()));
  const JointRoles roles = RolesOf(clip);
  const Draft draft = SampleOne(
      Make("kick", "recommended", {{"height_low", "3"}, {"height_high", "3"}, {"keyframe", "60"}}),
      clip, 1);
  const auto poses = motion::ForwardKinematics(draft.clip);
  const bool left = draft.ik->end_effector == JointRole::kLeftAnkle;
  const int hip = roles.joint(left ? JointRole::kLeftHip : JointRole::kRightHip);
  EXPECT_LT(MeasuredError(draft), 1e-3);
  EXPECT_GT(poses.position(60, hip + 1).z(), 0.1);  // the biped faces +Z
  EXPECT_NEAR(poses.position(60, hip + 1).x(), poses.position(60, hip).x(), 0.02);
}

TEST(IkSynthesizerConfigTest, TheIterationComesCloseToTheClosedForm) {
  const Clip clip = testing::SwingingClip(240);
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const Draft draft =
        SampleOne(Make("kick", "recommended", {{"solver", "iterative"}}), clip, seed);
    if (draft.ik->reachable) {
      EXPECT_LT(draft.ik->reached_error_m, 5e-3) << seed;
    }
  }
}

TEST(IkSynthesizerErrorsTest, MissingRolesShortClipsAndFarKeyframesAreRefused) {
  const Clip clip = testing::SwingingClip(3);
  EXPECT_EQ(base::ErrorReason(Make("kick").Check(clip, RolesOf(clip))), "CLIP_TOO_SHORT");
  const Clip longer = testing::SwingingClip(30);
  EXPECT_EQ(
      base::ErrorReason(Make("kick", "paper", {{"keyframe", "30"}}).Check(longer, RolesOf(longer))),
      "KEYFRAME_OUT_OF_RANGE");
  const auto chain = *motion::Skeleton::Create({{"a", -1, Vec3::Zero(), {}}});
  EXPECT_EQ(base::ErrorReason(Make("kick").Check(longer, *JointRoles::Detect(*chain))),
            "MISSING_ROLES");
  const auto wrong = *JointRoles::Detect(*longer.skeleton(), {{"left_knee", "right_knee"}});
  EXPECT_EQ(base::ErrorReason(Make("kick").Check(longer, wrong)), "BAD_LIMB");
}

}  // namespace
}  // namespace poise::synthesis
