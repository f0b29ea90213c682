// Feet: who stands stays, who swings comes down where it should, and legs reach it.
#include "core/push/restoration/step_planner.h"

#include <gmock/gmock.h>

#include "core/motion/joint_roles.h"
#include "core/push/push_scene.h"
#include "core/push/restoration/planted_feet.h"
#include "core/push/standing_person.h"

namespace poise::push {
namespace {

constexpr double kFloor = 0.02;

std::array<Vec3, 2> Standing() { return {Vec3(0, -0.1, kFloor), Vec3(0, 0.1, kFloor)}; }

std::array<FootWish, 2> Stay() {
  const Eigen::Vector2d right(0, -0.1), left(0, 0.1);
  return {FootWish{0, right, right}, FootWish{0, left, left}};
}

TEST(StepPlannerTest, FeetStandWhileNothingIsWantedOfThem) {
  StepPlanner planner(Standing());
  std::array<FootWish, 2> wishes = Stay();
  wishes[1].foothold.x() = 0.2;  // and yet none is on its way
  for (int frame = 0; frame < 100; ++frame) planner.Step({}, wishes, true);
  EXPECT_EQ(planner.toes(), Standing());
  EXPECT_FALSE(planner.swinging());
}

TEST(StepPlannerTest, AFootComesDownWhereItShouldAndClearsTheFloor) {
  const StepConfig config;
  StepPlanner planner(Standing());
  std::array<FootWish, 2> wishes = Stay();
  wishes[1].swings = 0.9;
  wishes[1].foothold = {0.5, 0.15};
  double highest = 0;
  int frames = 0;
  Vec3 before = planner.toes()[1];
  double fastest = 0;
  do {
    planner.Step(config, wishes, frames == 0);
    ASSERT_EQ(planner.toes()[0], Standing()[0]);
    highest = std::max(highest, planner.toes()[1].z());
    fastest = std::max(fastest, (planner.toes()[1] - before).head<2>().norm());
    before = planner.toes()[1];
    ++frames;
  } while (planner.swinging());
  EXPECT_LT((before - Vec3(0.5, 0.15, kFloor)).norm(), 1e-12);
  const double way = std::hypot(0.5, 0.05);
  EXPECT_NEAR(highest - kFloor, config.lift_m + config.lift_share * way, 2e-3);
  EXPECT_NEAR(frames, 1 + config.frames + config.frames_per_m * way, 1);
  // Minimum jerk: the highest speed is 15 / 8 of the mean one.
  EXPECT_NEAR(fastest, 15.0 / 8 * way / (frames - 1), 0.05 * fastest);
}

TEST(StepPlannerTest, OneFootStandsAtAnyTime) {
  StepPlanner planner(Standing());
  std::array<FootWish, 2> wishes = Stay();
  int steps = 0;
  for (int frame = 0; frame < 200; ++frame) {
    // Somebody who is pushed on and on: both are always wanted further ahead.
    for (FootWish& wish : wishes) {
      wish.swings = 0.9;
      wish.foothold.x() += 0.02;
      wish.balance = wish.foothold;
    }
    const auto before = planner.toes();
    planner.Step({}, wishes, true);
    for (int foot = 0; foot < 2; ++foot) {
      const bool came_down = before[foot].z() > kFloor && planner.toes()[foot].z() == kFloor;
      steps += came_down ? 1 : 0;
    }
    ASSERT_TRUE(planner.toes()[0] == before[0] || planner.toes()[1] == before[1]) << frame;
  }
  EXPECT_GT(steps, 4);
  EXPECT_LT((planner.toes()[0] - planner.toes()[1]).head<2>().norm(), 1.5);
}

TEST(StepPlannerTest, AFootTooFarBehindStepsWhateverIsSaid) {
  StepPlanner planner(Standing());
  std::array<FootWish, 2> wishes = Stay();
  wishes[0].foothold.x() = StepConfig().farthest_m + 0.01;
  planner.Step({}, wishes, true);
  EXPECT_TRUE(planner.swinging());
}

TEST(StepPlannerTest, WhoLeansForLongStepsUnderTheHip) {
  const StepConfig config;
  StepPlanner planner(Standing());
  std::array<FootWish, 2> wishes = Stay();
  for (FootWish& wish : wishes) wish.balance.x() -= config.balance_m - 0.01;
  for (int frame = 0; frame < 100; ++frame) planner.Step(config, wishes, true);
  EXPECT_FALSE(planner.swinging());
  for (FootWish& wish : wishes) wish.balance.x() -= 0.02;
  wishes[1].balance.x() -= 0.02;
  for (int frame = 0; frame < config.balance_frames; ++frame) planner.Step(config, wishes, true);
  EXPECT_FALSE(planner.swinging());
  do {
    planner.Step(config, wishes, true);
    ASSERT_EQ(planner.toes()[0], Standing()[0]);
  } while (planner.swinging());
  EXPECT_LT((planner.toes()[1].head<2>() - wishes[1].balance).norm(), 1e-12);
}

BodyShape Average() {
  const motion::Clip& clip = StandingPerson();
  return PersonOf(clip, 0, *motion::JointRoles::Detect(*clip.skeleton()))->shape;
}

BodyTurns NoTurns() {
  BodyTurns turns;
  turns.fill(math::Quat::Identity());
  return turns;
}

void ExpectBones(const BodyShape& first, const BodyShape& body) {
  for (int joint = 1; joint < kBodyJoints; ++joint) {
    const int parent = kBodyParents[joint];
    EXPECT_NEAR((body[joint] - body[parent]).norm(), (first[joint] - first[parent]).norm(), 1e-12);
  }
}

TEST(PlantFeetTest, ToesComeWhereTheyShouldAndBonesKeepTheirLengths) {
  const BodyShape first = Average();
  const std::array<Vec3, 2> toes = {first[kRightToe] + Vec3(0.25, 0.02, 0.08),
                                    first[kLeftToe] + Vec3(-0.1, 0, 0.06)};
  BodyTurns turns = NoTurns();
  PlantFeet(first, toes, turns);
  const BodyShape body = Turned(first, turns);
  EXPECT_LT((body[kRightToe] - toes[0]).norm(), 1e-9);
  EXPECT_LT((body[kLeftToe] - toes[1]).norm(), 1e-9);
  ExpectBones(first, body);
  EXPECT_EQ(body[kHead], first[kHead]);
  // The foot keeps its direction, the knee bends forward.
  const Vec3 foot = body[kRightToe] - body[kRightAnkle];
  EXPECT_LT((foot - (first[kRightToe] - first[kRightAnkle])).norm(), 1e-9);
  const Vec3 middle = (body[kRightHip] + body[kRightAnkle]) / 2;
  EXPECT_GT((body[kRightHip + 1] - middle).x(), 0.02);
}

TEST(PlantFeetTest, TheHeelRisesWhenTheLegIsTooShort) {
  const BodyShape first = Average();
  const std::array<Vec3, 2> toes = {first[kRightToe] - Vec3(0.45, 0, 0), first[kLeftToe]};
  BodyTurns turns = NoTurns();
  PlantFeet(first, toes, turns);
  const BodyShape body = Turned(first, turns);
  EXPECT_LT((body[kRightToe] - toes[0]).norm(), 1e-9);
  EXPECT_GT(body[kRightAnkle].z() - body[kRightToe].z(),
            first[kRightAnkle].z() - first[kRightToe].z() + 0.01);
  ExpectBones(first, body);
}

TEST(PlantFeetTest, AToeOutOfReachComesAsNearAsTheLegAllows) {
  const BodyShape first = Average();
  const std::array<Vec3, 2> toes = {first[kRightToe] - Vec3(3, 0, 0), first[kLeftToe]};
  BodyTurns turns = NoTurns();
  PlantFeet(first, toes, turns);
  const BodyShape body = Turned(first, turns);
  ExpectBones(first, body);
  const double leg = (first[kRightHip + 1] - first[kRightHip]).norm() +
                     (first[kRightAnkle] - first[kRightHip + 1]).norm() +
                     (first[kRightToe] - first[kRightAnkle]).norm();
  EXPECT_NEAR((body[kRightToe] - toes[0]).norm(), (toes[0] - body[kRightHip]).norm() - leg, 0.01);
}

}  // namespace
}  // namespace poise::push
