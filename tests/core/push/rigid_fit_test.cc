#include "core/push/restoration/rigid_fit.h"

#include <gmock/gmock.h>

#include "core/base/random.h"
#include "core/motion/joint_roles.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "core/push/restoration/turned_body.h"
#include "core/push/standing_person.h"
#include "tests/support/test_clips.h"

namespace poise::push {
namespace {

BodyTurns RandomTurns(uint64_t seed, double angle) {
  base::Random random(seed);
  BodyTurns turns;
  for (math::Quat& turn : turns) {
    turn = math::FromRotationVector(
        angle * Vec3(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1)));
  }
  return turns;
}

BodyShape Standing() {
  const motion::Clip& clip = StandingPerson();
  return ShapeOf(clip, 0, *motion::JointRoles::Detect(*clip.skeleton()));
}

double Farthest(const BodyShape& a, const BodyShape& b) {
  double worst = 0;
  for (int joint = 0; joint < kBodyJoints; ++joint) {
    worst = std::max(worst, (a[joint] - b[joint]).norm());
  }
  return worst;
}

TEST(RigidFitTest, ABodyThatWasTurnedIsFoundAgain) {
  const BodyShape first = Standing();
  for (uint64_t seed = 1; seed < 20; ++seed) {
    const BodyShape wanted = Turned(first, RandomTurns(seed, 0.8));
    EXPECT_LT(Farthest(Turned(first, FitTurns(first, wanted)), wanted), 1e-9) << seed;
  }
}

TEST(RigidFitTest, StretchedBodiesComeBackAtTheirBoneLengths) {
  const BodyShape first = Standing();
  base::Random random(3);
  BodyShape wanted = Turned(first, RandomTurns(4, 0.5));
  for (Vec3& joint : wanted) joint += 0.05 * Vec3(random.Normal(), random.Normal(), 0);
  const BodyShape fitted = Turned(first, FitTurns(first, wanted));
  for (int joint = 1; joint < kBodyJoints; ++joint) {
    const int parent = kBodyParents[joint];
    EXPECT_NEAR((fitted[joint] - fitted[parent]).norm(), (first[joint] - first[parent]).norm(),
                1e-12);
  }
}

TEST(RigidFitTest, TurnsOnASkeletonPutItsJointsWhereTheBodysAre) {
  const motion::Clip biped = poise::testing::SwingingClip(2);
  const auto roles = *motion::JointRoles::Detect(*biped.skeleton());
  const BodyShape first = ShapeOf(biped, 0, roles);
  BodyTurns turns = RandomTurns(5, 0.6);
  turns[1] = turns[2] = turns[3];  // the biped's spine is one bone
  const BodyShape expected = Turned(first, turns);
  const std::vector<math::Quat> rotations = TurnedBody(biped, roles).Rotations(turns);
  const motion::Clip turned =
      *motion::Clip::Create("turned", biped.skeleton(), 60, {biped.root_position(0)}, rotations);
  const motion::WorldPoses world = motion::ForwardKinematics(turned);
  const Vec3 pelvis = world.position(0, roles.joint(motion::JointRole::kPelvis));
  for (const auto& [role, joint] :
       {std::pair(motion::JointRole::kLeftKnee, 19), std::pair(motion::JointRole::kLeftAnkle, 20),
        std::pair(motion::JointRole::kRightToe, 17)}) {
    const Vec3 found = GroundFromWorld(world.position(0, roles.joint(role)) - pelvis);
    EXPECT_LT((found - expected[joint]).norm(), 1e-9) << motion::RoleName(role);
  }
}

}  // namespace
}  // namespace poise::push
