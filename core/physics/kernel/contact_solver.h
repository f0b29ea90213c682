#ifndef POISE_CORE_PHYSICS_KERNEL_CONTACT_SOLVER_H_
#define POISE_CORE_PHYSICS_KERNEL_CONTACT_SOLVER_H_

#include "core/physics/kernel/contacts.h"
#include "core/physics/kernel/factor.h"

/// Impulses that keep bodies apart and resist sliding: projected Gauss-Seidel over the points, each
/// with its normal and two tangents under a round friction cone (the velocity-level scheme of
/// Bullet's btMultiBodyConstraintSolver, with a cone instead of a pyramid). A point is carried by
/// the nodes between its bodies and the root only: with M = L^T D L its row is y = L^-T J^T, and
/// the velocities that all impulses make are kept as D^-1 y summed.
namespace poise::physics::POISE_KERNEL_ISA {

inline constexpr int kMaxRowNodes = 2 * kMaxDepth;

struct ContactRow {
  int num_nodes = 0;
  int nodes[kMaxRowNodes];  ///< falling
  M3 y[kMaxRowNodes];       ///< (node's speeds, normal and tangents)
  M3 z[kMaxRowNodes];       ///< D^-1 y
  M3 own;                   ///< y^T D^-1 y
  M3 directions;            ///< columns: normal, tangents
  V3 velocity;              ///< before impulses, along the directions
  V3 impulse;
  double tangent_scale = 1;  ///< bound of the tangents' part of `own`
  double wanted = 0;         ///< least velocity along the normal
};

inline M3 ContactDirections(const V3& normal) {
  M3 directions;
  const V3 tangent = std::abs(normal.y()) > 0.7 ? V3(V3::UnitX()) : V3(V3::UnitY());
  directions.col(0) = normal;
  directions.col(1) = (tangent - normal * normal.dot(tangent)).normalized();
  directions.col(2) = directions.col(1).cross(normal);
  return directions;
}

/// How a force along the directions at the point acts on a node: J^T, (3, 3).
inline M3 Leverage(const Kinematics& k, int node, const V3& point, const M3& directions) {
  if (node == 0) return directions;
  if (node == 1) return Cross(point) * directions;
  return k.rotation[node - 1].transpose() * (Cross(point - k.joint[node - 1]) * directions);
}

inline void MakeRow(const Topology& topology, const Kinematics& k, const Factor& factor,
                    const double* free_speeds, const Candidate& contact, ContactRow& row) {
  row.directions = ContactDirections(contact.normal);
  int index_of[kMaxNodes];
  const int a = contact.body + 1, b = contact.other < 0 ? -1 : contact.other + 1;
  row.num_nodes = 0;
  row.velocity.setZero();
  const auto add = [&](int node, double sign) {
    const int at = row.num_nodes++;
    index_of[node] = at;
    row.nodes[at] = node;
    if (sign == 0 || topology.frozen[node]) {
      row.y[at].setZero();
      return;
    }
    row.y[at] = sign * Leverage(k, node, contact.point, row.directions);
    row.velocity += row.y[at].transpose() * Vec(free_speeds + 3 * node);
  };
  int da = topology.depth[a], db = b < 0 ? -1 : topology.depth[b];
  while (da >= 0 || db >= 0) {  // both paths, merged
    const int na = da >= 0 ? topology.path[a][da] : -1, nb = db >= 0 ? topology.path[b][db] : -1;
    if (na == nb) {
      add(na, 0);
    } else {
      add(std::max(na, nb), na > nb ? 1 : -1);
    }
    if (na >= nb) --da;
    if (nb >= na) --db;
  }
  row.own.setZero();
  for (int at = 0; at < row.num_nodes; ++at) {
    const int node = row.nodes[at];
    for (int d = 0; d < topology.depth[node]; ++d) {
      row.y[index_of[topology.path[node][d]]].noalias() -=
          factor.lower[node][d].transpose() * row.y[at];
    }
    row.z[at].noalias() = factor.inverse[node] * row.y[at];
    row.own.noalias() += row.y[at].transpose() * row.z[at];
  }
  row.tangent_scale = std::max(row.own(1, 1), row.own(2, 2)) + std::abs(row.own(1, 2));
}

inline void ApplyImpulse(const ContactRow& row, const V3& impulse, double* response) {
  for (int at = 0; at < row.num_nodes; ++at) {
    Vec(response + 3 * row.nodes[at]).noalias() += row.z[at] * impulse;
  }
}

/// One visit of one point.
inline void Relax(ContactRow& row, double friction, double* response) {
  if (row.own(0, 0) < 1e-12) return;  // nothing there can move
  V3 velocity = row.velocity;
  for (int at = 0; at < row.num_nodes; ++at) {
    velocity.noalias() += row.y[at].transpose() * Vec(response + 3 * row.nodes[at]);
  }
  const V3 before = row.impulse;
  row.impulse[0] = std::max(0.0, before[0] + (row.wanted - velocity[0]) / row.own(0, 0));
  const double normal_change = row.impulse[0] - before[0];
  const double v1 = velocity[1] + row.own(1, 0) * normal_change;
  const double v2 = velocity[2] + row.own(2, 0) * normal_change;
  // One step length for both tangents: then where the cone's limit holds, friction ends up exactly
  // against the sliding; the exact solution of this point alone would be askew.
  row.impulse[1] -= v1 / row.tangent_scale;
  row.impulse[2] -= v2 / row.tangent_scale;
  const double most = friction * row.impulse[0];
  const double length = std::hypot(row.impulse[1], row.impulse[2]);
  if (length > most) row.impulse.tail<2>() *= most / length;
  ApplyImpulse(row, row.impulse - before, response);
}

/// Finds the impulses and adds what they do to `speeds` (which come without them).
inline void SolveContacts(const Topology& topology, const Kinematics& k, const Factor& factor,
                          const StepSettings& settings, double step, const Candidates& found,
                          const StepState& state, ContactRow* rows, double* speeds) {
  double response[3 * kMaxNodes] = {};
  for (int c = 0; c < found.count; ++c) {
    const Candidate& contact = found.list[c];
    ContactRow& row = rows[c];
    MakeRow(topology, k, factor, speeds, contact, row);
    row.wanted = contact.distance > 0 ? -contact.distance / step
                                      : -contact.distance * settings.contact_erp / step;
    row.impulse.setZero();
    for (int old = 0; old < state.num_contacts; ++old) {
      const ContactPoint& last = state.contacts[old];
      if (last.body == contact.body && last.other == contact.other &&
          last.feature == contact.feature) {
        row.impulse = settings.warm_start * Vec(last.impulse);
        ApplyImpulse(row, row.impulse, response);
        break;
      }
    }
  }
  for (int pass = 0; pass < settings.solver_iterations; ++pass) {
    for (int c = 0; c < found.count; ++c) Relax(rows[c], settings.friction, response);
  }
  SolveDown(topology, factor, response);
  for (int i = 0; i < 3 * topology.num_nodes; ++i) speeds[i] += response[i];
}

}  // namespace poise::physics::POISE_KERNEL_ISA

#endif  // POISE_CORE_PHYSICS_KERNEL_CONTACT_SOLVER_H_
