#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "core/physics/bullet_engine.h"
#include "core/physics/world.h"
#include "tests/core/physics/test_bodies.h"

/// The equations of motion against closed forms, conservation laws and Bullet's own.
namespace poise::physics {
namespace {

const Vec3 kGravity(0, -9.8, 0);

World MakeWorld(const Articulation& tree, WorldConfig config) {
  return std::move(World::Create(tree, config)).value();
}

WorldConfig Empty(double rate_hz = 600) {
  WorldConfig config;
  config.rate_hz = rate_hz;
  config.ground = false;
  config.self_collision = false;
  return config;
}

HumanoidModelPtr FreeWristed() {
  HumanoidConfig config;
  config.fixed_wrists = false;
  return TestHumanoid(config);
}

// Without motors and without limits.
Articulation Limp(Articulation tree) {
  for (Body& body : tree.bodies) body.stiffness = body.damping = body.torque_limit = 0;
  return tree;
}

void Simulate(World& world, double seconds, const Drive& drive = {}) {
  const int steps = static_cast<int>(std::lround(seconds / world.step_s()));
  for (int step = 0; step < steps; ++step) world.Step(drive);
}

TEST(DynamicsTest, MassMatrixAndBiasForceAreBullets) {
  for (const bool fixed_wrists : {false, true}) {
    HumanoidConfig config;
    config.fixed_wrists = fixed_wrists;
    const HumanoidModelPtr model = TestHumanoid(config);
    const Articulation& tree = model->articulation();
    BulletEngine bullet(tree, StepSettings());
    base::Random random(7);
    for (int trial = 0; trial < 6; ++trial) {
      const State state = RandomState(tree, random, 5);
      const Speeds bias = BiasForce(tree, state, kGravity);
      // The force that holds all accelerations at 0 does so in Bullet, too.
      EXPECT_LT(bullet.FreeAcceleration(state, bias).norm(), 1e-9 * bias.norm());
      // And each column of the mass matrix gives its unit acceleration.
      const MassMatrix mass = ComputeMassMatrix(tree, state);
      for (int column = 0; column < tree.num_speeds(); ++column) {
        if (column >= 6 && tree.bodies[column / 3 - 1].rigid_joint) continue;
        const Speeds force = bias + mass.col(column);
        const Speeds unit = Speeds::Unit(column);
        EXPECT_LT((bullet.FreeAcceleration(state, force) - unit).norm(), 1e-9)
            << "column " << column << " of trial " << trial;
      }
    }
  }
}

TEST(DynamicsTest, InverseDynamicsIsMassTimesAccelerationPlusBias) {
  const HumanoidModelPtr model = FreeWristed();
  base::Random random(3);
  const State state = RandomState(model->articulation(), random, 5);
  Speeds acceleration;
  for (double& a : acceleration) a = random.Uniform(-10, 10);
  const Speeds expected = ComputeMassMatrix(model->articulation(), state) * acceleration +
                          BiasForce(model->articulation(), state, kGravity);
  const Speeds force = InverseDynamics(model->articulation(), state, acceleration, kGravity);
  EXPECT_LT((force - expected).norm(), 1e-12 * expected.norm());
}

TEST(DynamicsTest, ALimpBodyFallsFreely) {
  const Articulation tree = Limp(FreeWristed()->articulation());
  World world = MakeWorld(tree, Empty());
  State state;
  state.root_position = Vec3(0, 10, 0);
  world.Reset(state);
  Simulate(world, 1);
  EXPECT_NEAR(world.state().speeds[1], -9.8, 1e-6);
  EXPECT_LT((world.state().speeds - Speeds::Unit(1) * world.state().speeds[1]).norm(), 1e-6);
}

TEST(DynamicsTest, MomentumStaysWithoutOuterForces) {
  const Articulation tree = Limp(FreeWristed()->articulation());
  WorldConfig config = Empty();
  config.gravity_mps2 = 0;
  base::Random random(11);
  World world = MakeWorld(tree, config);
  world.Reset(RandomState(tree, random, 3));
  const Conserved before = ComputeConserved(tree, world.state(), Vec3::Zero());
  Simulate(world, 1);
  const Conserved after = ComputeConserved(tree, world.state(), Vec3::Zero());
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-9 * before.momentum.norm());
  EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(),
            1e-9 * before.angular_momentum.norm());
}

TEST(DynamicsTest, InnerTorquesLeaveMomentumAlone) {
  const HumanoidModelPtr model = TestHumanoid();
  WorldConfig config = Empty();
  config.gravity_mps2 = 0;
  config.self_collision = true;
  World world = MakeWorld(model->articulation(), config);
  world.Reset(State());
  Drive drive;
  base::Random random(5);
  for (int i = 1; i < kMaxBodies; ++i) {
    drive.target_rotations[i] = RandomState(model->articulation(), random, 0).rotations[i];
  }
  Simulate(world, 0.1, drive);
  const Conserved after = ComputeConserved(world.articulation(), world.state(), Vec3::Zero());
  EXPECT_GT(after.kinetic_energy, 1e-3);
  EXPECT_LT(after.momentum.norm(), 1e-9);
  EXPECT_LT(after.angular_momentum.norm(), 1e-9);
}

// How far the energy, averaged over a second, goes from the first second to the worst of ten,
// against what the swing exchanges; and its largest momentary error.
struct EnergyError {
  double drift = 0;
  double ripple = 0;
};

EnergyError MeasureEnergy(double rate_hz, const Vec3& speed) {
  World world = MakeWorld(Pendulum(), Empty(rate_hz));
  State state;
  state.rotations[1] = math::FromRotationVector(Vec3(0, 0, 1.2));
  state.speeds.segment<3>(SpeedIndex(1)) = speed;
  world.Reset(state);
  const auto energy = [&] {
    const Conserved now = ComputeConserved(world.articulation(), world.state(), kGravity);
    return now.kinetic_energy + now.potential_energy;
  };
  const double start = energy(), exchanged = 2 * 9.8 * 0.5 * (1 - std::cos(1.2));
  EnergyError error;
  double first = 0;
  for (int second = 0; second < 10; ++second) {
    double mean = 0;
    for (int step = 0; step < rate_hz; ++step) {
      world.Step({});
      mean += energy() / rate_hz;
      error.ripple = std::max(error.ripple, std::abs(energy() - start) / exchanged);
    }
    if (second == 0) first = mean;
    error.drift = std::max(error.drift, std::abs(mean - first) / exchanged);
  }
  return error;
}

TEST(DynamicsTest, APendulumKeepsItsEnergyAndBetterSoWithShorterSteps) {
  const EnergyError coarse = MeasureEnergy(600, Vec3::Zero());
  const EnergyError fine = MeasureEnergy(1200, Vec3::Zero());
  EXPECT_LT(coarse.drift, 0.01);
  EXPECT_LT(coarse.ripple, 0.01);
  EXPECT_LT(fine.drift, 0.6 * coarse.drift);
  EXPECT_LT(fine.ripple, 0.6 * coarse.ripple);
}

TEST(DynamicsTest, APendulumThatWhirlsKeepsItsEnergyBetterWithShorterSteps) {
  const EnergyError coarse = MeasureEnergy(600, Vec3(2, 1, 0));
  const EnergyError fine = MeasureEnergy(1200, Vec3(2, 1, 0));
  EXPECT_LT(coarse.drift, 0.02);
  EXPECT_LT(fine.drift, 0.6 * coarse.drift);
}

TEST(DynamicsTest, TheControllersStepResponseIsTheClosedForm) {
  Articulation tree = Pendulum();
  Eigen::Map<Vec3>(tree.bodies[1].center_of_mass).setZero();
  Body& body = tree.bodies[1];
  const double inertia = 0.02;
  for (const double damping : {0.1, 0.4, 2.0}) {  // under-damped, critical, over-damped
    body.stiffness = 2;
    body.damping = damping;
    World world = MakeWorld(tree, Empty());
    Drive drive;
    drive.target_rotations[1] = math::FromRotationVector(Vec3(0.5, 0, 0));
    const std::complex<double> root =
        std::sqrt(std::complex<double>(damping * damping - 4 * inertia * body.stiffness, 1e-9));
    const auto fast = (-damping - root) / (2 * inertia), slow = (-damping + root) / (2 * inertia);
    for (int step = 1; step <= 600; ++step) {
      world.Step(drive);
      const double t = step * world.step_s();
      const auto expected =
          0.5 * (1.0 + (slow * std::exp(fast * t) - fast * std::exp(slow * t)) / (fast - slow));
      const double angle = math::ToRotationVector(world.state().rotations[1]).x();
      EXPECT_NEAR(angle, expected.real(), 0.02 * 0.5) << "damping " << damping << " t " << t;
    }
  }
}

TEST(DynamicsTest, ATorqueLimitHoldsAndIsCounted) {
  Articulation tree = Pendulum();
  tree.bodies[1].stiffness = 1000;
  tree.bodies[1].torque_limit = 3;
  World world = MakeWorld(tree, Empty());
  Drive drive;
  drive.target_rotations[1] = math::FromRotationVector(Vec3(1, 0.5, 0));
  world.Step(drive);
  EXPECT_EQ(world.effort().saturated_joints, 1);
  EXPECT_NEAR(world.effort().torques.norm(), 3, 1e-12);
}

}  // namespace
}  // namespace poise::physics
