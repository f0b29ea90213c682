#include "core/physics/humanoid_model.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/motion/editing/reduce.h"
#include "core/motion/io/clip_file.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "core/physics/floor_alignment.h"
#include "core/physics/world.h"
#include "tests/core/physics/test_bodies.h"
#include "tests/support/data_files.h"
#include "tests/support/test_clips.h"

namespace poise::physics {
namespace {

using enum motion::JointRole;

HumanoidConfig FreeWrists() {
  HumanoidConfig config;
  config.fixed_wrists = false;
  return config;
}

TEST(HumanoidModelTest, HasTheReferencesBodiesMassAndFreedoms) {
  const HumanoidModelPtr free = TestHumanoid(FreeWrists()), fixed = TestHumanoid();
  const auto sum = [](const auto& weights) {
    return std::accumulate(weights.begin(), weights.end(), 0.0);
  };
  EXPECT_EQ(free->articulation().num_bodies, 16);
  EXPECT_NEAR(free->total_mass(), 45, 1e-12);
  EXPECT_EQ(free->degrees_of_freedom(), 51);
  EXPECT_EQ(fixed->degrees_of_freedom(), 45);
  EXPECT_NEAR(sum(free->joint_weights()), 5.5, 1e-12);
  EXPECT_NEAR(sum(fixed->joint_weights()), 5.3, 1e-12);
}

TEST(HumanoidModelTest, ScalesGainsLimitsAndInertiasWithTheBodyMass) {
  HumanoidConfig heavy;
  heavy.body_mass_kg = 90;
  const Articulation light = TestHumanoid()->articulation();
  const HumanoidModelPtr model = TestHumanoid(heavy);
  EXPECT_NEAR(model->total_mass(), 90, 1e-12);
  EXPECT_NEAR(model->residual_gains().stiffness, 400, 1e-12);
  for (int i = 0; i < kMaxBodies; ++i) {
    const Body &a = light.bodies[i], &b = model->articulation().bodies[i];
    EXPECT_NEAR(b.stiffness, 2 * a.stiffness, 1e-12);
    EXPECT_NEAR(b.damping, 2 * a.damping, 1e-12);
    EXPECT_NEAR(b.torque_limit, 2 * a.torque_limit, 1e-12);
    for (int k = 0; k < 9; ++k) EXPECT_NEAR(b.inertia[k], 2 * a.inertia[k], 1e-12);
  }
}

TEST(HumanoidModelTest, APelvisTenCentimetresBehindIsPulledByTwentyNewtons) {
  const HumanoidModelPtr model = TestHumanoid();
  WorldConfig config;
  config.gravity_mps2 = 0;
  World world = std::move(World::Create(model->articulation(), config)).value();
  State state;
  state.root_position = Vec3(0, 5, 0);
  world.Reset(state);
  Drive drive;
  drive.target_root = Vec3(0.1, 5, 0);
  drive.residual = model->residual_gains();
  // Implicit: less by what the pull itself will have done by the end of the step.
  world.Step(drive);
  EXPECT_NEAR(world.effort().residual_force.x(), 20, 0.2);
  EXPECT_LT(world.effort().residual_force.tail<2>().norm(), 0.1);
}

TEST(HumanoidModelTest, FeetAreMirrorImages) {
  const motion::SkeletonPtr skeleton = testing::Biped();
  const motion::JointRoles roles = *motion::JointRoles::Detect(*skeleton);
  const motion::Soles askew = {.right = *motion::MakeSole({0.3, 0.9, -0.2}, {0, 0, 1}),
                               .left = *motion::MakeSole({-0.1, 1, 0.1}, {0, 0, 1})};
  const motion::Soles soles = SymmetricSoles(*skeleton, roles, askew);
  const Vec3 mirror(-1, 1, 1);
  EXPECT_LT((mirror.cwiseProduct(soles.right.up) - soles.left.up).norm(), 1e-9);
  EXPECT_LT((mirror.cwiseProduct(soles.right.forward) - soles.left.forward).norm(), 1e-9);
  const Vec3 mean = (askew.left.up + mirror.cwiseProduct(askew.right.up)).normalized();
  EXPECT_LT((soles.left.up - mean).norm(), 1e-9);
}

TEST(HumanoidModelTest, RefusesValuesOutOfRangeAndUnknownPresets) {
  HumanoidConfig config;
  config.body_mass_kg = 1;
  const motion::SkeletonPtr skeleton = testing::Biped();
  const motion::JointRoles roles = *motion::JointRoles::Detect(*skeleton);
  const auto model = HumanoidModel::Create(*skeleton, roles, {}, config);
  EXPECT_EQ(base::ErrorReason(model.status()), "CONFIG_VALUE_OUT_OF_RANGE");
  EXPECT_EQ(base::ErrorReason(HumanoidConfig::FromPreset("best").status()), "UNKNOWN_PRESET");
  EXPECT_FALSE(HumanoidConfig::FromPreset("paper")->fixed_wrists);
}

// One clip of each kind of skeleton.
const char* const kFiles[] = {
    "hdm05/kickLFront1Reps/HDM_bd_kickLFront1Reps_001_120.amc", "cmu/test/walking/walking_1.txt",
    "bandai/dataset-1/dataset-1_kick_normal_001.bvh", "fzj_push/single/X09/Tue_03_p_03_m_X-09.bvh"};

class RealSkeletonTest : public ::testing::TestWithParam<const char*> {};

TEST_P(RealSkeletonTest, GetsFeetThatStandLevelOnTheFloorOfItsClip) {
  POISE_REQUIRE_DATA(GetParam());
  const motion::Clip clip = motion::ReadClipFile(testing::DataPath(GetParam()))->clip;
  const motion::JointRoles roles = *motion::JointRoles::Detect(*clip.skeleton());
  const motion::Clip reduced =
      *motion::ReduceToRoles(clip, roles, motion::ReductionMode::kComposed);
  const motion::JointRoles reduced_roles = *motion::JointRoles::Detect(*reduced.skeleton());
  const HumanoidModelPtr model = *HumanoidModel::Create(reduced, reduced_roles);
  const motion::Clip aligned = AlignToFloor(reduced, model->shapes(), FloorRule::kLowest);
  EXPECT_NEAR(FloorHeight(aligned, model->shapes(), FloorRule::kLowest), 0, 1e-9);
  const double median = FloorHeight(aligned, model->shapes(), FloorRule::kMedian);
  EXPECT_GE(median, 0);
  EXPECT_LT(median, 0.06);
  // Some frame has a sole that is level to 10 degrees.
  const motion::WorldPoses world = motion::ForwardKinematics(aligned);
  double flattest = 0;
  for (int frame = 0; frame < world.num_frames; ++frame) {
    for (const motion::BodyShape& shape : model->shapes()) {
      if (shape.kind != motion::ShapeKind::kBox) continue;
      const Vec3 up = world.rotation(frame, shape.joint) * shape.orientation * Vec3::UnitY();
      flattest = std::max(flattest, up.y());
    }
  }
  EXPECT_GT(flattest, 0.985);
}

INSTANTIATE_TEST_SUITE_P(Files, RealSkeletonTest, ::testing::ValuesIn(kFiles));

}  // namespace
}  // namespace poise::physics
