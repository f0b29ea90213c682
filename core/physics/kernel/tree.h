#ifndef POISE_CORE_PHYSICS_KERNEL_TREE_H_
#define POISE_CORE_PHYSICS_KERNEL_TREE_H_

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/physics/articulation.h"

/// Kinematics, bias force and mass matrix of an articulation, built once per instruction set.
/// All vectors are in world axes and all points relative to the root's position, so that composite
/// inertias add up without transforms and a far root costs no precision.
/// The unit of the matrices is a node: three speeds. Node 0 is the root's linear velocity, node 1
/// its angular velocity, node i + 1 the joint of body i.
namespace poise::physics::POISE_KERNEL_ISA {

using V3 = Eigen::Matrix<double, 3, 1>;
using M3 = Eigen::Matrix<double, 3, 3>;
using Q4 = Eigen::Quaternion<double>;
using ConstV3 = Eigen::Map<const V3>;
using MutV3 = Eigen::Map<V3>;
using ConstM3 = Eigen::Map<const M3>;

inline MutV3 Vec(double* numbers) { return MutV3(numbers); }
inline ConstV3 Vec(const double* numbers) { return ConstV3(numbers); }

inline constexpr int kMaxNodes = kMaxBodies + 1;
inline constexpr int kMaxDepth = 8;  ///< nodes from the root to a hand

inline M3 Cross(const V3& v) {
  M3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Which nodes lie between a node and the root. path[n][depth[n]] = n.
struct Topology {
  int num_nodes = 0;
  int depth[kMaxNodes];
  int path[kMaxNodes][kMaxDepth];
  bool frozen[kMaxNodes];  ///< no freedom: a rigid joint, or both nodes of a fixed base
};

inline void MakeTopology(const Articulation& tree, Topology& topology) {
  topology.num_nodes = tree.num_bodies + 1;
  for (int n = 0; n < topology.num_nodes; ++n) {
    const int parent = n < 2 ? n - 1 : tree.bodies[n - 1].parent + 1;
    topology.depth[n] = parent < 0 ? 0 : topology.depth[parent] + 1;
    for (int d = 0; d < topology.depth[n]; ++d) topology.path[n][d] = topology.path[parent][d];
    topology.path[n][topology.depth[n]] = n;
    topology.frozen[n] = n < 2 ? tree.fixed_base : tree.bodies[n - 1].rigid_joint;
  }
}

/// Where the bodies are and how they move.
struct Kinematics {
  M3 rotation[kMaxBodies];  ///< world from body
  V3 joint[kMaxBodies];     ///< relative to the root's position
  V3 center[kMaxBodies];    ///< centre of mass
  V3 angular[kMaxBodies];   ///< angular velocity
  V3 linear[kMaxBodies];    ///< velocity of the joint
};

inline void ComputeKinematics(const Articulation& tree, const double* rotations,
                              const double* speeds, Kinematics& k) {
  k.rotation[0] = Eigen::Map<const Q4>(rotations).toRotationMatrix();
  k.joint[0].setZero();
  k.center[0] = k.rotation[0] * Vec(tree.bodies[0].center_of_mass);
  k.linear[0] = Vec(speeds);
  k.angular[0] = Vec(speeds + 3);
  for (int i = 1; i < tree.num_bodies; ++i) {
    const Body& body = tree.bodies[i];
    const int p = body.parent;
    const V3 arm = k.rotation[p] * Vec(body.offset);
    k.rotation[i].noalias() =
        k.rotation[p] * Eigen::Map<const Q4>(rotations + 4 * i).toRotationMatrix();
    k.joint[i] = k.joint[p] + arm;
    k.center[i] = k.joint[i] + k.rotation[i] * Vec(body.center_of_mass);
    k.linear[i] = k.linear[p] + k.angular[p].cross(arm);
    k.angular[i] = k.angular[p] + k.rotation[i] * Vec(speeds + 3 + 3 * i);
  }
}

/// Recursive Newton-Euler: the force that gives the accelerations (null: none) under gravity.
/// Without accelerations this is the bias force (Coriolis, centrifugal, gravity).
inline void InverseDynamics(const Articulation& tree, const Kinematics& k, const M3* inertia,
                            const double* speeds, const double* accelerations, const V3& gravity,
                            double* forces) {
  V3 angular[kMaxBodies], linear[kMaxBodies];  // accelerations of body and joint
  V3 force[kMaxBodies], moment[kMaxBodies];    // that the joint passes on, about the joint
  for (int i = 0; i < tree.num_bodies; ++i) {
    const Body& body = tree.bodies[i];
    const V3& w = k.angular[i];
    if (i == 0) {
      linear[0] = -gravity;
      angular[0].setZero();
      if (accelerations) {
        linear[0] += Vec(accelerations);
        angular[0] = Vec(accelerations + 3);
      }
    } else {
      const int p = body.parent;
      const V3 arm = k.joint[i] - k.joint[p];
      const V3 relative = k.rotation[i] * Vec(speeds + 3 + 3 * i);
      linear[i] = linear[p] + angular[p].cross(arm) + k.angular[p].cross(k.angular[p].cross(arm));
      angular[i] = angular[p] + k.angular[p].cross(relative);
      if (accelerations) angular[i] += k.rotation[i] * Vec(accelerations + 3 + 3 * i);
    }
    const V3 c = k.center[i] - k.joint[i];
    force[i] = body.mass * (linear[i] + angular[i].cross(c) + w.cross(w.cross(c)));
    moment[i] = inertia[i] * angular[i] + w.cross(inertia[i] * w) + c.cross(force[i]);
  }
  for (int i = tree.num_bodies - 1; i > 0; --i) {
    const int p = tree.bodies[i].parent;
    force[p] += force[i];
    moment[p] += moment[i] + (k.joint[i] - k.joint[p]).cross(force[i]);
    Vec(forces + 3 + 3 * i) =
        tree.bodies[i].rigid_joint ? V3(V3::Zero()) : V3(k.rotation[i].transpose() * moment[i]);
  }
  Vec(forces + 0) = force[0];
  Vec(forces + 3) = moment[0];
}

/// Inertia of each body about its centre of mass, in world axes.
inline void ComputeInertias(const Articulation& tree, const Kinematics& k, M3* inertia) {
  for (int i = 0; i < tree.num_bodies; ++i) {
    inertia[i].noalias() =
        k.rotation[i] * ConstM3(tree.bodies[i].inertia) * k.rotation[i].transpose();
  }
}

/// The mass matrix's lower part by blocks: block[n][d] couples node n to the node at depth d of its
/// path; all others are 0.
struct MassBlocks {
  M3 block[kMaxNodes][kMaxDepth];
};

/// Composite rigid bodies. Frozen nodes get a unit block and no coupling.
inline void ComputeMass(const Articulation& tree, const Topology& topology, const Kinematics& k,
                        const M3* inertia, MassBlocks& mass) {
  double m[kMaxBodies];
  V3 first[kMaxBodies];   // mass times centre, about the root
  M3 second[kMaxBodies];  // inertia about the root
  for (int i = 0; i < tree.num_bodies; ++i) {
    const V3& c = k.center[i];
    m[i] = tree.bodies[i].mass;
    first[i] = m[i] * c;
    second[i] = inertia[i] - first[i] * c.transpose();
    second[i].diagonal().array() += first[i].dot(c);
  }
  for (int i = tree.num_bodies - 1; i > 0; --i) {
    const int p = tree.bodies[i].parent;
    m[p] += m[i];
    first[p] += first[i];
    second[p] += second[i];
  }
  for (int n = topology.num_nodes - 1; n >= 0; --n) {
    const int depth = topology.depth[n];
    M3* row = mass.block[n];
    if (topology.frozen[n]) {
      for (int d = 0; d < depth; ++d) row[d].setZero();
      row[depth].setIdentity();
      continue;
    }
    const int i = n < 2 ? 0 : n - 1;
    M3 push, turn;  // momentum of a unit speed, the turning part about the root
    if (n == 0) {
      push = m[0] * M3::Identity();
    } else {
      const M3 axes = n == 1 ? M3(M3::Identity()) : k.rotation[i];
      const V3& at = k.joint[i];
      push.noalias() = -Cross(first[i] - m[i] * at) * axes;
      turn.noalias() = second[i] * axes + Cross(first[i]) * (Cross(at) * axes);
    }
    for (int d = 0; d <= depth; ++d) {
      const int a = topology.path[n][d];
      if (topology.frozen[a]) {
        row[d].setZero();
      } else if (a == 0) {
        row[d] = push.transpose();
      } else if (a == 1) {
        row[d] = turn.transpose();
      } else {
        row[d].noalias() = (turn - Cross(k.joint[a - 1]) * push).transpose() * k.rotation[a - 1];
      }
    }
  }
}

}  // namespace poise::physics::POISE_KERNEL_ISA

#endif  // POISE_CORE_PHYSICS_KERNEL_TREE_H_
