#include "core/physics/kernel/contact_solver.h"
#include "core/physics/kernel/controller.h"
#include "core/physics/kernel/momentum.h"

namespace poise::physics::POISE_KERNEL_ISA {
namespace {

// What one substep computes and the next one reuses.
struct Workspace {
  Topology topology;
  Kinematics kinematics;
  M3 inertia[kMaxBodies];
  MassBlocks mass;
  Factor factor;
  Momentum whole;
  double bias[kMaxSpeeds];
  Candidates found;
  ContactRow rows[kMaxContacts];
};

// Where everything is and how it moves, from the state.
void Locate(const Articulation& tree, const StepState& state, Workspace& w) {
  ComputeKinematics(tree, state.rotations, state.speeds, w.kinematics);
  ComputeInertias(tree, w.kinematics, w.inertia);
}

void ComputeEquations(const Articulation& tree, const StepSettings& settings,
                      const StepState& state, Workspace& w) {
  InverseDynamics(tree, w.kinematics, w.inertia, state.speeds, nullptr, Vec(settings.gravity),
                  w.bias);
  ComputeMass(tree, w.topology, w.kinematics, w.inertia, w.mass);
}

// Semi-implicit Euler: positions move with the new speeds.
void Integrate(const Articulation& tree, double step, StepState& state) {
  using MutQ4 = Eigen::Map<Q4>;
  Vec(state.root_position) += step * Vec(state.speeds);
  MutQ4 root(state.rotations);
  root = (Exponential(step * Vec(state.speeds + 3)) * root).normalized();
  for (int i = 1; i < tree.num_bodies; ++i) {
    if (tree.bodies[i].rigid_joint) continue;
    MutQ4 joint(state.rotations + 4 * i);
    joint = (joint * Exponential(step * Vec(state.speeds + 3 + 3 * i))).normalized();
  }
}

void KeepContacts(const Workspace& w, StepState& state) {
  state.num_contacts = w.found.count;
  for (int c = 0; c < w.found.count; ++c) {
    const Candidate& from = w.found.list[c];
    ContactPoint& to = state.contacts[c];
    to.body = from.body;
    to.other = from.other;
    to.feature = from.feature;
    to.distance = from.distance;
    Vec(to.point) = from.point + Vec(state.root_position);
    Vec(to.normal) = from.normal;
    Vec(to.impulse) = w.rows[c].impulse;
  }
}

// What gravity, the wrench and the ground do to momentum, about the root where it was.
void AddOuterImpulses(const StepSettings& settings, const double* forces, double step,
                      const Workspace& w, V3& linear, V3& angular) {
  const V3 gravity = Vec(settings.gravity);
  linear += step * (w.whole.mass * gravity + Vec(forces));
  angular += step * (w.whole.first.cross(gravity) + Vec(forces + 3));
  for (int c = 0; c < w.found.count; ++c) {
    if (w.found.list[c].other >= 0) continue;
    const V3 impulse = w.rows[c].directions * w.rows[c].impulse;
    linear += impulse;
    angular += w.found.list[c].point.cross(impulse);
  }
}

// Moves on and corrects the momentum; leaves the workspace located at the new state.
void Move(const Articulation& tree, const StepSettings& settings, const double* forces, double step,
          StepState& state, Workspace& w) {
  const bool conserve = settings.conserve_momentum && !tree.fixed_base;
  V3 linear, angular;
  if (conserve) {
    ComputeMomentum(tree, w.kinematics, w.inertia, w.whole);
    linear = w.whole.linear;
    angular = w.whole.angular;
    AddOuterImpulses(settings, forces, step, w, linear, angular);
    angular -= (step * Vec(state.speeds)).cross(linear);  // about the root where it will be
  }
  Integrate(tree, step, state);
  Locate(tree, state, w);
  if (conserve) {
    ComputeMomentum(tree, w.kinematics, w.inertia, w.whole);
    CorrectMomentum(tree, linear, angular, w.whole, w.kinematics, state.speeds);
  }
}

void Substep(const Articulation& tree, const StepSettings& settings, const double* forces,
             StepState& state, Workspace& w) {
  const double step = settings.step_s / settings.substeps;
  const double none[kMaxNodes] = {};
  FactorInPlace(w.topology, w.mass, none, w.factor);
  double change[kMaxSpeeds];
  for (int i = 0; i < tree.num_speeds(); ++i) change[i] = forces[i] - w.bias[i];
  for (int n = 0; n < w.topology.num_nodes; ++n) {
    if (w.topology.frozen[n]) Vec(change + 3 * n).setZero();
  }
  Solve(w.topology, w.factor, change);
  w.found.count = 0;
  if (settings.ground) {
    FindGroundContacts(tree, w.kinematics, state.root_position[1], step, w.found);
  }
  if (settings.self_collision) FindSelfContacts(tree, w.kinematics, step, w.found);
  for (int i = 0; i < tree.num_speeds(); ++i) state.speeds[i] += step * change[i];
  if (w.found.count > 0) {
    SolveContacts(w.topology, w.kinematics, w.factor, settings, step, w.found, state, w.rows,
                  state.speeds);
  }
  KeepContacts(w, state);
  Move(tree, settings, forces, step, state, w);
}

}  // namespace

void StepKernel(const Articulation& tree, const StepSettings& settings, const StepDrive& drive,
                StepState& state, StepEffort& effort) {
  Workspace w;
  MakeTopology(tree, w.topology);
  Locate(tree, state, w);
  ComputeEquations(tree, settings, state, w);
  double forces[kMaxSpeeds];
  Control({tree, settings, drive, state, w.topology, w.bias}, w.mass, forces, effort);
  for (int substep = 0; substep < settings.substeps; ++substep) {
    if (substep > 0) ComputeEquations(tree, settings, state, w);
    Substep(tree, settings, forces, state, w);
  }
}

void ControlKernel(const Articulation& tree, const StepSettings& settings, const StepDrive& drive,
                   const StepState& state, double* forces, StepEffort& effort) {
  Workspace w;
  MakeTopology(tree, w.topology);
  Locate(tree, state, w);
  ComputeEquations(tree, settings, state, w);
  Control({tree, settings, drive, state, w.topology, w.bias}, w.mass, forces, effort);
}

void DynamicsKernel(const DynamicsArguments& arguments) {
  const Articulation& tree = *arguments.tree;
  Topology topology;
  MakeTopology(tree, topology);
  Kinematics kinematics;
  M3 inertia[kMaxBodies];
  ComputeKinematics(tree, arguments.rotations, arguments.speeds, kinematics);
  ComputeInertias(tree, kinematics, inertia);
  if (arguments.forces) {
    InverseDynamics(tree, kinematics, inertia, arguments.speeds, arguments.accelerations,
                    Vec(arguments.gravity), arguments.forces);
  }
  if (!arguments.mass) return;
  MassBlocks mass;
  ComputeMass(tree, topology, kinematics, inertia, mass);
  const int speeds = tree.num_speeds();
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>> out(arguments.mass, speeds,
                                                                        speeds);
  out.setZero();
  for (int n = 0; n < topology.num_nodes; ++n) {
    for (int d = 0; d <= topology.depth[n]; ++d) {
      const int a = topology.path[n][d];
      out.block<3, 3>(3 * n, 3 * a) = mass.block[n][d];
      out.block<3, 3>(3 * a, 3 * n) = mass.block[n][d].transpose();
    }
  }
}

}  // namespace poise::physics::POISE_KERNEL_ISA
