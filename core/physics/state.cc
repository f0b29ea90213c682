#include "core/physics/state.h"

#include "core/base/isa.h"
#include "core/physics/step_types.h"

namespace poise::physics {
namespace {

// The kernels read these as plain numbers.
static_assert(sizeof(std::array<Quat, kMaxBodies>) == 4 * kMaxBodies * sizeof(double));

void RunDynamics(const DynamicsArguments& arguments) {
  static const auto kernel =
      base::SelectKernel(isa_v2::DynamicsKernel, isa_v3::DynamicsKernel, isa_v4::DynamicsKernel);
  kernel(arguments);
}

DynamicsArguments Arguments(const Articulation& tree, const State& state, const Vec3& gravity) {
  return {.tree = &tree,
          .rotations = state.rotations[0].coeffs().data(),
          .speeds = state.speeds.data(),
          .accelerations = nullptr,
          .gravity = {gravity.x(), gravity.y(), gravity.z()},
          .forces = nullptr,
          .mass = nullptr};
}

}  // namespace

BodyFrames ComputeFrames(const Articulation& tree, const State& state) {
  BodyFrames frames;
  frames.positions[0] = state.root_position;
  frames.rotations[0] = state.rotations[0];
  for (int i = 1; i < tree.num_bodies; ++i) {
    const int p = tree.bodies[i].parent;
    frames.positions[i] =
        frames.positions[p] + frames.rotations[p] * Eigen::Map<const Vec3>(tree.bodies[i].offset);
    frames.rotations[i] = frames.rotations[p] * state.rotations[i];
  }
  return frames;
}

Speeds InverseDynamics(const Articulation& tree, const State& state, const Speeds& accelerations,
                       const Vec3& gravity) {
  Speeds forces = Speeds::Zero();
  DynamicsArguments arguments = Arguments(tree, state, gravity);
  arguments.accelerations = accelerations.data();
  arguments.forces = forces.data();
  RunDynamics(arguments);
  return forces;
}

Speeds BiasForce(const Articulation& tree, const State& state, const Vec3& gravity) {
  return InverseDynamics(tree, state, Speeds::Zero(), gravity);
}

MassMatrix ComputeMassMatrix(const Articulation& tree, const State& state) {
  MassMatrix mass(tree.num_speeds(), tree.num_speeds());
  DynamicsArguments arguments = Arguments(tree, state, Vec3::Zero());
  arguments.mass = mass.data();
  RunDynamics(arguments);
  return mass;
}

Conserved ComputeConserved(const Articulation& tree, const State& state, const Vec3& gravity) {
  const BodyFrames frames = ComputeFrames(tree, state);
  std::array<Vec3, kMaxBodies> linear, angular;
  Conserved sum;
  for (int i = 0; i < tree.num_bodies; ++i) {
    const Body& body = tree.bodies[i];
    if (i == 0) {
      linear[0] = state.speeds.head<3>();
      angular[0] = state.speeds.segment<3>(3);
    } else {
      const int p = body.parent;
      linear[i] = linear[p] + angular[p].cross(frames.positions[i] - frames.positions[p]);
      angular[i] = angular[p] + frames.rotations[i] * state.speeds.segment<3>(SpeedIndex(i));
    }
    const Vec3 arm = frames.rotations[i] * Eigen::Map<const Vec3>(body.center_of_mass);
    const Vec3 velocity = linear[i] + angular[i].cross(arm);
    const math::Mat3 turn = frames.rotations[i].toRotationMatrix();
    const Vec3 spin =
        turn * Eigen::Map<const math::Mat3>(body.inertia) * turn.transpose() * angular[i];
    const Vec3 center = frames.positions[i] + arm;
    sum.momentum += body.mass * velocity;
    sum.angular_momentum += spin + body.mass * center.cross(velocity);
    sum.kinetic_energy += (body.mass * velocity.squaredNorm() + spin.dot(angular[i])) / 2;
    sum.potential_energy -= body.mass * gravity.dot(center);
  }
  return sum;
}

}  // namespace poise::physics
