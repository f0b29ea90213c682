// The scenes of reference push.md sec. 12 with their physics, on the statue forecaster.
#include "core/push/pendulum/crowd.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numbers>

#include "core/motion/joint_roles.h"
#include "core/push/body_joints.h"
#include "core/push/push_forecaster.h"
#include "core/push/standing_person.h"

namespace poise::push {
namespace {

ScenePerson PersonAt(double x, double y, double mass = 75) {
  const motion::Clip& clip = StandingPerson();
  ScenePerson person = *PersonOf(clip, 0, *motion::JointRoles::Detect(*clip.skeleton()));
  person.mass_kg = mass;
  person.hip += Vec3(x, y, 0);
  person.pendulum.position.head<2>() += Eigen::Vector2d(x, y);
  return person;
}

ScenePush PushOn(int person, double impulse, int first_frame = 0, int frames = 12) {
  return {.person = person,
          .first_frame = first_frame,
          .frames = frames,
          .force_n = Eigen::Vector2d(impulse * kFrameRate / frames, 0)};
}

PushScene LineScene(int people, double spacing, double impulse) {
  PushScene scene{.people = {}, .pushes = {PushOn(0, impulse)}, .frames = 181};
  for (int i = 0; i < people; ++i) scene.people.push_back(PersonAt(i * spacing, 0));
  return scene;
}

// Rows of 1, 3, 5, 3, 1 people; the rear one is pushed.
PushScene DiamondScene(double impulse) {
  PushScene scene{.people = {}, .pushes = {PushOn(0, impulse)}, .frames = 181};
  for (int row = 0; row < 5; ++row) {
    const int side = std::min(row, 4 - row);
    for (int i = -side; i <= side; ++i) {
      scene.people.push_back(PersonAt(0.45 * row, 0.45 * i));
    }
  }
  return scene;
}

struct Outcome {
  std::vector<PushFrame> frames;

  const std::vector<int>& onsets() const { return frames.back().onset_frames; }
  double PeakSpeed(int person) const {
    double peak = 0;
    for (const PushFrame& frame : frames) {
      peak = std::max(peak, RodEndVelocities(frame.states).row(person).matrix().norm());
    }
    return peak;
  }
  double MinDistance() const {
    double least = 1e9;
    for (const PushFrame& frame : frames) {
      for (int i = 0; i < frame.hips.rows(); ++i) {
        for (int j = 0; j < i; ++j) {
          const auto between = frame.hips.row(i).leftCols<2>() - frame.hips.row(j).leftCols<2>();
          least = std::min(least, between.matrix().norm());
        }
      }
    }
    return least;
  }
  double PeakLean() const {
    double peak = 0;
    for (const PushFrame& frame : frames) {
      peak = std::max(peak, frame.states.position.rightCols<2>().abs().maxCoeff());
    }
    return peak;
  }
};

Outcome Forecast(const PushScene& scene, const base::Overrides& overrides = {}) {
  const auto forecaster = MakeStatueForecaster(overrides);
  EXPECT_TRUE(forecaster.ok()) << forecaster.status();
  const auto rollout = (*forecaster)->Start(scene);
  Outcome outcome;
  for (int frame = 0; frame < scene.frames; ++frame) {
    const auto next = rollout->Next();
    EXPECT_TRUE(next.ok()) << next.status();
    outcome.frames.push_back(**next);
  }
  return outcome;
}

constexpr double kStrong = 65;            // [N s]
constexpr double kRadius = 0.15;          // [m] of a trunk
constexpr double kLargestOverlap = 0.05;  // [m]

TEST(CrowdTest, NobodyPushedStandsStillExactly) {
  PushScene scene = LineScene(10, 0.25, 0);
  scene.pushes.clear();
  const Outcome outcome = Forecast(scene);
  EXPECT_THAT(outcome.onsets(), ::testing::Each(-1));
  EXPECT_LT((outcome.frames.back().hips - outcome.frames.front().hips).abs().maxCoeff(), 1e-9);
}

TEST(CrowdTest, APushTravelsAlongALineOfTenAndReachesTheFront) {
  const Outcome outcome = Forecast(LineScene(10, 0.35, kStrong));
  for (int i = 0; i < 10; ++i) ASSERT_GE(outcome.onsets()[i], 0) << "person " << i;
  for (int i = 1; i < 10; ++i) EXPECT_GT(outcome.onsets()[i], outcome.onsets()[i - 1]) << i;
  EXPECT_GT(outcome.MinDistance(), 2 * kRadius - kLargestOverlap);
  EXPECT_LT(outcome.PeakLean(), 0.6);
}

TEST(CrowdTest, AStrongerPushIsNeverFeltLater) {
  std::vector<int> before(10, 1 << 20);
  for (const double impulse : {20.0, 30.0, 45.0, 65.0, 90.0, 120.0}) {
    const Outcome outcome = Forecast(LineScene(10, 0.35, impulse));
    for (int i = 0; i < 10; ++i) {
      const int onset = outcome.onsets()[i] < 0 ? 1 << 20 : outcome.onsets()[i];
      EXPECT_LE(onset, before[i]) << "person " << i << " at " << impulse << " N s";
      before[i] = onset;
    }
  }
}

TEST(CrowdTest, ADiamondOfThirteenIsSymmetricAndNobodyIsRunThrough) {
  const Outcome outcome = Forecast(DiamondScene(kStrong));
  EXPECT_GT(outcome.MinDistance(), 2 * kRadius - kLargestOverlap);
  // Row 2 is people 4 .. 8, from right to left.
  const auto& hips = outcome.frames.back().hips;
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(hips(4 + i, 0), hips(8 - i, 0), 1e-6);
    EXPECT_NEAR(hips(4 + i, 1), -hips(8 - i, 1), 1e-6);
  }
  // The column in the middle moves, from the rear to the front.
  for (const auto& [behind, ahead] : {std::pair(0, 2), std::pair(2, 6), std::pair(6, 10)}) {
    EXPECT_GE(outcome.onsets()[behind], 0);
    EXPECT_GT(outcome.onsets()[ahead], outcome.onsets()[behind]);
  }
}

TEST(CrowdTest, MomentumIsWhatPushAndFloorGive) {
  const PushScene scene = LineScene(10, 0.3, 90);
  Crowd crowd(scene, {});
  Eigen::Array2d given = Eigen::Array2d::Zero();
  for (int frame = 0; frame < 120; ++frame) {
    crowd.Step(PushForces(scene, frame, crowd.states()));
    given += ForceInFrame(scene.pushes[0], frame).array() * kFrameTime;
    given += crowd.floor_force().colwise().sum().transpose() * kFrameTime;
    EXPECT_LT(crowd.interaction().leftCols<2>().colwise().sum().abs().maxCoeff(), 1e-9);
  }
  const Eigen::Array2d momentum =
      HorizontalMomentum(crowd.states(), crowd.bodies().mass).colwise().sum().transpose();
  EXPECT_NEAR(momentum[0], given[0], 0.5);  // of 90 N s: the step is not infinitely small
  EXPECT_NEAR(momentum[1], given[1], 1e-6);
}

TEST(CrowdTest, WithoutFloorForcesThePushesImpulseStays) {
  PushScene scene = LineScene(4, 0.35, 60);
  PhysicsConfig frictionless{.friction = 0, .stepping = 0, .substeps = 16};
  Crowd crowd(scene, frictionless);
  for (int frame = 0; frame < 40; ++frame) {
    crowd.Step(PushForces(scene, frame, crowd.states()));
  }
  EXPECT_NEAR(HorizontalMomentum(crowd.states(), crowd.bodies().mass).col(0).sum(), 60, 0.3);
}

TEST(CrowdTest, APushInAnyDirectionMovesThatWayAsFar) {
  PushScene scene{.people = {PersonAt(0, 0)}, .pushes = {PushOn(0, 30)}, .frames = 91};
  // No lean at first, so that all directions are alike.
  scene.people[0].pendulum.position.tail<2>().setZero();
  const auto travel = [&](double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    scene.pushes[0].force_n =
        Eigen::Vector2d(std::cos(angle), std::sin(angle)) * 30 * kFrameRate / 12;
    const Outcome outcome = Forecast(scene);
    const Eigen::Array2d moved =
        (outcome.frames.back().hips - outcome.frames.front().hips).leftCols<2>().row(0).transpose();
    EXPECT_NEAR(std::atan2(moved[1], moved[0]), angle, 1e-2) << degrees;
    return moved.matrix().norm();
  };
  const double forward = travel(0);
  EXPECT_GT(forward, 0.1);
  for (const double degrees : {45.0, 90.0, 135.0, -90.0}) {
    EXPECT_NEAR(travel(degrees), forward, 0.01 * forward);
  }
}

TEST(CrowdTest, AnExtraStrongPushAcceleratesMoreAndIsSurvived) {
  const Outcome strong = Forecast({{PersonAt(0, 0)}, {PushOn(0, kStrong)}, 181});
  const Outcome extra = Forecast({{PersonAt(0, 0)}, {PushOn(0, 1.3736 * kStrong)}, 181});
  EXPECT_GT(extra.PeakSpeed(0), 1.2 * strong.PeakSpeed(0));
  EXPECT_LT(extra.PeakLean(), 0.6);
  EXPECT_LT(RodEndVelocities(extra.frames.back().states).matrix().norm(), 0.1);
}

TEST(CrowdTest, ThreePushesMoveFartherEachTime) {
  const PushScene scene{
      {PersonAt(0, 0)}, {PushOn(0, 25, 0), PushOn(0, 40, 15), PushOn(0, 65, 50)}, 181};
  const Outcome outcome = Forecast(scene);
  const auto speed = [&](int frame) {
    return RodEndVelocities(outcome.frames[frame].states)(0, 0);
  };
  EXPECT_GT(speed(12), 0.1);
  EXPECT_GT(speed(27), speed(12));
  EXPECT_GT(speed(62), speed(27));
}

TEST(CrowdTest, AThousandPeopleStandAndMoveWithoutBadNumbers) {
  PushScene scene{.people = {}, .pushes = {PushOn(0, 120)}, .frames = 31};
  for (int i = 0; i < 1000; ++i) scene.people.push_back(PersonAt(0.4 * (i / 25), 0.4 * (i % 25)));
  const Outcome outcome = Forecast(scene);
  EXPECT_TRUE(outcome.frames.back().hips.allFinite());
}

TEST(CrowdTest, UnknownAndBadHyperParametersAreRefused) {
  EXPECT_EQ(MakeStatueForecaster({{"physics.frictoin", "1"}}).status().code(),
            absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(MakeStatueForecaster({{"physics.friction", "-1"}}).status().code(),
            absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace poise::push
