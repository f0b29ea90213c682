#ifndef POISE_CORE_PHYSICS_KERNEL_MOMENTUM_H_
#define POISE_CORE_PHYSICS_KERNEL_MOMENTUM_H_

#include "core/physics/kernel/tree.h"

/// Whole-body momentum. The speeds of one substep are found with the mass matrix of its beginning;
/// at its end the same speeds mean a slightly different momentum (second order in the step). Since
/// only outer forces may change momentum, the root's six speeds are corrected to carry exactly what
/// the outer impulses left.
namespace poise::physics::POISE_KERNEL_ISA {

struct Momentum {
  double mass;
  V3 first;    ///< mass times centre, about the root's position
  M3 inertia;  ///< about the whole body's centre of mass
  V3 linear;
  V3 angular;  ///< about the root's position
};

inline void ComputeMomentum(const Articulation& tree, const Kinematics& k, const M3* inertia,
                            Momentum& whole) {
  whole.mass = 0;
  whole.first.setZero();
  whole.inertia.setZero();
  whole.linear.setZero();
  whole.angular.setZero();
  for (int i = 0; i < tree.num_bodies; ++i) {
    const double m = tree.bodies[i].mass;
    const V3& c = k.center[i];
    const V3 push = m * (k.linear[i] + k.angular[i].cross(c - k.joint[i]));
    whole.mass += m;
    whole.first += m * c;
    whole.inertia += inertia[i] - m * c * c.transpose();
    whole.inertia.diagonal().array() += m * c.squaredNorm();
    whole.linear += push;
    whole.angular += inertia[i] * k.angular[i] + c.cross(push);
  }
  whole.inertia += whole.first * whole.first.transpose() / whole.mass;
  whole.inertia.diagonal().array() -= whole.first.squaredNorm() / whole.mass;
}

/// Changes the root's speeds, and with them all bodies' velocities, so that the whole has this
/// momentum.
inline void CorrectMomentum(const Articulation& tree, const V3& linear, const V3& angular,
                            const Momentum& whole, Kinematics& k, double* speeds) {
  const V3 push = linear - whole.linear, turn = angular - whole.angular;
  const V3 center = whole.first / whole.mass;
  const V3 spin = whole.inertia.ldlt().solve(turn - center.cross(push));
  const V3 shift = push / whole.mass - spin.cross(center);
  for (int i = 0; i < tree.num_bodies; ++i) {
    k.linear[i] += shift + spin.cross(k.joint[i]);
    k.angular[i] += spin;
  }
  Vec(speeds) += shift;
  Vec(speeds + 3) += spin;
}

}  // namespace poise::physics::POISE_KERNEL_ISA

#endif  // POISE_CORE_PHYSICS_KERNEL_MOMENTUM_H_
