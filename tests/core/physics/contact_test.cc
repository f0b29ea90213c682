#include <gtest/gtest.h>

#include <cmath>

#include "core/physics/world.h"
#include "tests/core/physics/test_bodies.h"

/// The ground and the bodies against each other, in both engines where they should agree.
namespace poise::physics {
namespace {

World MakeWorld(const Articulation& tree, const WorldConfig& config) {
  return std::move(World::Create(tree, config)).value();
}

Articulation Limp(Articulation tree) {
  for (Body& body : tree.bodies) body.stiffness = body.damping = body.torque_limit = 0;
  return tree;
}

// A single box of 10 kg, 0.4 m long and wide and 0.2 m high.
Articulation Box() {
  Articulation tree;
  tree.num_bodies = 1;
  Body& body = tree.bodies[0];
  body.mass = 10;
  body.geometry = Geometry::kBox;
  Eigen::Map<Vec3>(body.half_extents) = Vec3(0.2, 0.1, 0.2);
  Eigen::Map<math::Mat3>(body.inertia) = Vec3(0.1667, 0.2667, 0.1667).asDiagonal();
  return tree;
}

// Height at which the test humanoid's soles touch the ground.
double StandingHeight(const HumanoidModel& model) {
  const BodyFrames frames = ComputeFrames(model.articulation(), State());
  double lowest = 0;
  for (int i = 0; i < kMaxBodies; ++i) {
    const motion::BodyShape& shape = model.shapes()[i];
    if (shape.kind != motion::ShapeKind::kBox) continue;
    const Quat turn = frames.rotations[i] * shape.orientation;
    const Vec3 center = frames.positions[i] + frames.rotations[i] * shape.center;
    lowest = std::min(
        lowest, center.y() - turn.toRotationMatrix().row(1).cwiseAbs().dot(shape.half_extents));
  }
  return -lowest;
}

State Standing(const HumanoidModel& model, double above = 0) {
  State state;
  state.root_position = Vec3(0, StandingHeight(model) + above, 0);
  return state;
}

Drive HoldAt(const HumanoidModel& model, const State& state) {
  Drive drive;
  drive.target_rotations = state.rotations;
  drive.target_root = state.root_position;
  drive.residual = model.residual_gains();
  return drive;
}

double GroundForce(const World& world) {
  double sum = 0;
  for (const ContactPoint& contact : world.contacts()) {
    if (contact.other < 0) sum += contact.impulse[0] * contact.normal[1];
  }
  return sum * world.config().substeps / world.step_s();
}

class EngineTest : public ::testing::TestWithParam<const char*> {
 protected:
  WorldConfig Config() const {
    WorldConfig config;
    config.engine = GetParam();
    return config;
  }
};
INSTANTIATE_TEST_SUITE_P(Engines, EngineTest, ::testing::Values("own", "bullet"));

TEST_P(EngineTest, ABoxSlidesAsFarAsFrictionLets) {
  WorldConfig config = Config();
  config.friction = std::sqrt(0.5);
  World world = MakeWorld(Box(), config);
  State state;
  state.root_position = Vec3(0, 0.1, 0);
  state.speeds[0] = 2;
  world.Reset(state);
  for (int step = 0; step < 600; ++step) world.Step({});
  const double expected = 2 * 2 / (2 * 0.5 * 9.8);
  EXPECT_NEAR(world.state().root_position.x(), expected, 0.02 * expected);
  EXPECT_NEAR(world.state().root_position.y(), 0.1, 1e-3);
  EXPECT_LT(world.state().speeds.norm(), 1e-3);
}

TEST_P(EngineTest, AFallenLimpBodyComesToRestOnTheGround) {
  const HumanoidModelPtr model = TestHumanoid();
  World world = MakeWorld(Limp(model->articulation()), Config());
  State state = Standing(*model, 0.3);
  state.speeds[0] = 0.5;
  world.Reset(state);
  for (int step = 0; step < 4 * 600; ++step) world.Step({});
  const BodyFrames frames = ComputeFrames(model->articulation(), world.state());
  for (int i = 0; i < kMaxBodies; ++i) EXPECT_GT(frames.positions[i].y(), -0.01) << "body " << i;
  EXPECT_LT(frames.positions[3].y(), 0.5);
  EXPECT_LT(world.state().speeds.head<3>().norm(), 0.3);
  double deepest = 0;
  for (const ContactPoint& contact : world.contacts()) {
    deepest = std::min(deepest, contact.distance);
  }
  EXPECT_GT(deepest, -0.01);
}

TEST_P(EngineTest, TheGroundCarriesTheWeightOfAStandingBody) {
  const HumanoidModelPtr model = TestHumanoid();
  World world = MakeWorld(model->articulation(), Config());
  const State state = Standing(*model);
  world.Reset(state);
  const Drive drive = HoldAt(*model, state);
  double mean = 0;
  for (int step = 0; step < 1200; ++step) {
    world.Step(drive);
    if (step >= 600) mean += GroundForce(world) / 600;
  }
  const double weight = 45 * 9.8;
  EXPECT_NEAR(mean + world.effort().residual_force.y(), weight, 0.02 * weight);
  EXPECT_LT(world.effort().residual_force.norm(), 0.1 * weight);
  EXPECT_LT((world.state().root_position - state.root_position).norm(), 0.05);
}

TEST(ContactTest, TheEnginesMoveAnUprightBodyAlike) {
  const HumanoidModelPtr model = TestHumanoid();
  const State state = Standing(*model, 0.02);
  Drive drive = HoldAt(*model, state);
  drive.target_rotations[4] = math::FromRotationVector(Vec3(-0.5, 0, 0));
  drive.target_rotations[5] = math::FromRotationVector(Vec3(0.9, 0, 0));
  State end[2];
  for (const char* engine : {"own", "bullet"}) {
    WorldConfig config;
    config.engine = engine;
    World world = MakeWorld(model->articulation(), config);
    world.Reset(state);
    for (int step = 0; step < 240; ++step) world.Step(drive);
    end[engine[0] == 'b'] = world.state();
  }
  EXPECT_LT((end[0].root_position - end[1].root_position).norm(), 0.01);
  for (int i = 0; i < kMaxBodies; ++i) {
    EXPECT_LT(math::GeodesicDistance(end[0].rotations[i], end[1].rotations[i]), 0.03) << i;
  }
}

TEST(ContactTest, HandsDoNotPassThroughEachOther) {
  const HumanoidModelPtr model = TestHumanoid();
  for (const bool self_collision : {true, false}) {
    WorldConfig config;
    config.ground = false;
    config.gravity_mps2 = 0;
    config.self_collision = self_collision;
    World world = MakeWorld(model->articulation(), config);
    Drive drive;  // both arms to the front and across
    drive.target_rotations[7] = math::FromRotationVector(Vec3(0, 2.1, 0));
    drive.target_rotations[13] = math::FromRotationVector(Vec3(0, -2.1, 0));
    double nearest = 1;
    for (int step = 0; step < 600; ++step) {
      world.Step(drive);
      for (const ContactPoint& contact : world.contacts()) {
        nearest = std::min(nearest, contact.distance);
      }
    }
    const BodyFrames frames = ComputeFrames(model->articulation(), world.state());
    const bool crossed = frames.positions[9].x() > frames.positions[15].x();
    EXPECT_EQ(crossed, !self_collision);
    if (self_collision) {
      EXPECT_GT(nearest, -0.01);
    }
  }
}

TEST(ContactTest, ARunGoesOnExactlyFromWhatWasSaved) {
  const HumanoidModelPtr model = TestHumanoid();
  World world = MakeWorld(model->articulation(), {});
  const State state = Standing(*model, 0.01);
  world.Reset(state);
  Drive drive = HoldAt(*model, state);
  drive.target_rotations[4] = math::FromRotationVector(Vec3(-0.8, 0.1, 0));
  for (int step = 0; step < 100; ++step) world.Step(drive);
  const StepState saved = world.Save();
  for (int step = 0; step < 200; ++step) world.Step(drive);
  World other = MakeWorld(model->articulation(), {});
  other.Restore(saved);
  for (int step = 0; step < 200; ++step) other.Step(drive);
  EXPECT_EQ(world.state().speeds, other.state().speeds);
  EXPECT_EQ(world.state().root_position, other.state().root_position);
  for (int i = 0; i < kMaxBodies; ++i) {
    EXPECT_EQ(world.state().rotations[i].coeffs(), other.state().rotations[i].coeffs());
  }
}

TEST(ContactTest, RefusesWhatIsNoTree) {
  Articulation tree = TestHumanoid()->articulation();
  tree.bodies[3].parent = 7;
  EXPECT_EQ(base::ErrorReason(World::Create(tree).status()), "BAD_ARTICULATION");
  tree = TestHumanoid()->articulation();
  tree.bodies[5].mass = 0;
  EXPECT_EQ(base::ErrorReason(World::Create(tree).status()), "BAD_ARTICULATION");
  WorldConfig config;
  config.engine = "bullet";
  EXPECT_EQ(base::ErrorReason(World::Create(Pendulum(), config).status()), "UNSUPPORTED_ENGINE");
  config.engine = "ode";
  EXPECT_EQ(base::ErrorReason(World::Create(tree, config).status()), "CONFIG_VALUE_OUT_OF_RANGE");
}

}  // namespace
}  // namespace poise::physics
