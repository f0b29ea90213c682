#include "core/push/pendulum/pendulum.h"

#include <gmock/gmock.h>

#include <cmath>

#include "core/base/random.h"

namespace poise::push {
namespace {

constexpr int kPeople = 7;

struct Sample {
  PendulumStates states;
  PersonArray mass;
};

Sample RandomSample(uint64_t seed) {
  base::Random random(seed);
  Sample sample{{PendulumArray(kPeople, 4), PendulumArray(kPeople, 4), PersonArray(kPeople)},
                PersonArray(kPeople)};
  for (int i = 0; i < kPeople; ++i) {
    for (int k = 0; k < 4; ++k) {
      sample.states.position(i, k) = random.Uniform(-0.6, 0.6);
      sample.states.velocity(i, k) = random.Uniform(-2, 2);
    }
    sample.states.rod[i] = random.Uniform(0.8, 1.1);
    sample.mass[i] = random.Uniform(50, 120);
  }
  return sample;
}

PendulumArray RandomForce(uint64_t seed) {
  base::Random random(seed);
  PendulumArray force(kPeople, 4);
  for (double& value : force.reshaped()) value = random.Uniform(-500, 500);
  return force;
}

// Kinetic minus potential energy, written down from where cart and bob are, by differences of the
// rod's end: nothing of the program's equations but RodEnds.
PersonArray Lagrangian(const PendulumArray& position, const PendulumArray& velocity,
                       const PersonArray& rod, const PersonArray& mass) {
  constexpr double kStep = 1e-6;
  const PersonArray ground = PersonArray::Zero(kPeople);
  const auto end = [&](double step) {
    return RodEnds({position + step * velocity, velocity, rod}, ground);
  };
  const Eigen::ArrayX3d bob = (end(kStep) - end(-kStep)) / (2 * kStep);
  return 0.5 * 0.1 * mass * velocity.leftCols(2).square().rowwise().sum() +
         0.5 * 0.9 * mass * bob.square().rowwise().sum() - 0.9 * mass * 9.81 * end(0).col(2);
}

TEST(PendulumTest, EquationsAreLagranges) {
  const Sample sample = RandomSample(1);
  const auto& [q, v, rod] = sample.states;
  base::Random random(2);
  PendulumArray acceleration(kPeople, 4);
  for (double& value : acceleration.reshaped()) value = random.Uniform(-5, 5);
  const PendulumArray force = InverseDynamics(sample.states, sample.mass, acceleration);
  constexpr double kStep = 1e-3;
  for (int k = 0; k < 4; ++k) {
    // d/dt (dL/dv) - dL/dq along q(t) = q + v t + a t^2 / 2.
    const auto slope = [&](bool by_velocity, double time) {
      const PendulumArray at = q + time * v + 0.5 * time * time * acceleration;
      const PendulumArray rate = v + time * acceleration;
      PendulumArray more = at, more_rate = rate, less = at, less_rate = rate;
      (by_velocity ? more_rate : more).col(k) += kStep;
      (by_velocity ? less_rate : less).col(k) -= kStep;
      return PersonArray((Lagrangian(more, more_rate, rod, sample.mass) -
                          Lagrangian(less, less_rate, rod, sample.mass)) /
                         (2 * kStep));
    };
    const PersonArray expected =
        (slope(true, kStep) - slope(true, -kStep)) / (2 * kStep) - slope(false, 0);
    EXPECT_LT((force.col(k) - expected).abs().maxCoeff(), 5e-3) << "coordinate " << k;
  }
}

TEST(PendulumTest, AccelerationsUndoInverseDynamics) {
  const Sample sample = RandomSample(3);
  const PendulumArray force = RandomForce(4);
  const PendulumArray acceleration = Accelerations(sample.states, sample.mass, force);
  EXPECT_LT((InverseDynamics(sample.states, sample.mass, acceleration) - force).abs().maxCoeff(),
            1e-9);
}

TEST(PendulumTest, WithoutForcesEnergyAndHorizontalMomentumStay) {
  Sample sample = RandomSample(5);
  sample.states.velocity *= 0.3;
  const PersonArray energy = Energy(sample.states, sample.mass);
  const Eigen::ArrayX2d momentum = HorizontalMomentum(sample.states, sample.mass);
  const PendulumArray none = PendulumArray::Zero(kPeople, 4);
  constexpr double kStep = 2e-6;
  for (double time = 0; time < 0.25; time += kStep) {
    sample.states.velocity += kStep * Accelerations(sample.states, sample.mass, none);
    sample.states.position += kStep * sample.states.velocity;
  }
  EXPECT_LT((Energy(sample.states, sample.mass) - energy).abs().maxCoeff(), 2e-2);
  EXPECT_LT((HorizontalMomentum(sample.states, sample.mass) - momentum).abs().maxCoeff(), 1e-2);
}

TEST(PendulumTest, SmallLeanGrowsAsTheLinearisedPendulumOnAFreeCart) {
  Sample sample = RandomSample(6);
  sample.states.position.setZero();
  sample.states.velocity.setZero();
  sample.states.position.col(2) = 1e-4;
  const PersonArray rate = (kGravity / (kCartFraction * sample.states.rod)).sqrt();
  const PendulumArray none = PendulumArray::Zero(kPeople, 4);
  constexpr double kStep = 1e-5, kTime = 0.3;
  const int steps = static_cast<int>(std::lround(kTime / kStep));
  for (int i = 0; i < steps; ++i) {
    sample.states.velocity += kStep * Accelerations(sample.states, sample.mass, none);
    sample.states.position += kStep * sample.states.velocity;
  }
  const PersonArray expected = 1e-4 * (rate * kTime).cosh();
  EXPECT_LT((sample.states.position.col(2) / expected - 1).abs().maxCoeff(), 2e-3);
}

TEST(PendulumTest, ForceAtTheRodDoesTheWorkOfThePointItActsOn) {
  const Sample sample = RandomSample(7);
  Eigen::ArrayX2d force(kPeople, 2);
  force.col(0) = 120;
  force.col(1) = -75;
  const PendulumArray generalised = AtRod(sample.states, force, PersonArray::Constant(kPeople, 1));
  const PersonArray power = (generalised * sample.states.velocity).rowwise().sum();
  const PersonArray expected =
      (force * RodEndVelocities(sample.states).leftCols(2)).rowwise().sum();
  EXPECT_LT((power - expected).abs().maxCoeff(), 1e-9);
}

TEST(PendulumTest, RodEndVelocitiesAreDifferencesOfRodEnds) {
  const Sample sample = RandomSample(8);
  const PersonArray ground = PersonArray::Zero(kPeople);
  PendulumStates later = sample.states, earlier = sample.states;
  later.position += 1e-6 * sample.states.velocity;
  earlier.position -= 1e-6 * sample.states.velocity;
  const Eigen::ArrayX3d expected = (RodEnds(later, ground) - RodEnds(earlier, ground)) / 2e-6;
  EXPECT_LT((RodEndVelocities(sample.states) - expected).abs().maxCoeff(), 1e-8);
}

TEST(PendulumTest, PoseOfABodyPutsTheRodsEndAtTheHip) {
  const Vec3 hip(0.3, -0.2, 1.05), right(0.1, -0.1, 0.09), left(0.0, 0.15, 0.11);
  const PendulumPose pose = PendulumOf(hip, right, left);
  const PendulumStates states{pose.position.transpose().array(), PendulumArray::Zero(1, 4),
                              PersonArray::Constant(1, pose.rod)};
  const Eigen::ArrayX3d end = RodEnds(states, PersonArray::Constant(1, pose.cart_height));
  EXPECT_LT((end.row(0).matrix().transpose() - hip).norm(), 1e-12);
  EXPECT_GT(pose.position[2], 0);  // leans forward
  EXPECT_GT(pose.position[3], 0);  // and to the right
}

}  // namespace
}  // namespace poise::push
