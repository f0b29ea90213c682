#ifndef POISE_CORE_PHYSICS_KERNEL_FACTOR_H_
#define POISE_CORE_PHYSICS_KERNEL_FACTOR_H_

#include "core/physics/kernel/tree.h"

/// M = L^T D L along the tree (Featherstone, Rigid Body Dynamics Algorithms, sec. 8.6, with blocks
/// of three): no fill-in, so a solve touches only what lies between a body and the root.
namespace poise::physics::POISE_KERNEL_ISA {

struct Factor {
  M3 lower[kMaxNodes][kMaxDepth];  ///< block of L for the node at depth d of the path, below D
  M3 inverse[kMaxNodes];           ///< of D
};

inline M3 InverseOfSymmetric(const M3& m) {
  const double a = m(0, 0), b = m(1, 0), c = m(2, 0), d = m(1, 1), e = m(2, 1), f = m(2, 2);
  const double A = d * f - e * e, B = c * e - b * f, C = b * e - c * d;
  const double scale = 1 / (a * A + b * B + c * C);
  const double D = (a * f - c * c) * scale, E = (b * c - a * e) * scale,
               F = (a * d - b * b) * scale;
  M3 out;
  out << A * scale, B * scale, C * scale, B * scale, D, E, C * scale, E, F;
  return out;
}

/// Factors M + diag(damping); `damping` has one number per node. The blocks are used up.
inline void FactorInPlace(const Topology& topology, MassBlocks& mass, const double* damping,
                          Factor& factor) {
  for (int n = topology.num_nodes - 1; n >= 0; --n) {
    const int depth = topology.depth[n];
    M3* row = mass.block[n];
    row[depth].diagonal().array() += damping[n];
    factor.inverse[n] = InverseOfSymmetric(row[depth]);
    if (topology.frozen[n]) {
      for (int d = 0; d < depth; ++d) factor.lower[n][d].setZero();
      continue;
    }
    for (int d = 0; d < depth; ++d) {
      factor.lower[n][d].noalias() = factor.inverse[n] * row[d];
      M3* above = mass.block[topology.path[n][d]];
      const M3 transposed = row[d].transpose();
      for (int e = 0; e <= d; ++e) above[e].noalias() -= transposed * factor.lower[n][e];
    }
  }
}

/// x = L^-T x, from the leaves to the root.
inline void SolveUp(const Topology& topology, const Factor& factor, double* x) {
  for (int n = topology.num_nodes - 1; n > 0; --n) {
    const V3 xn = Vec(x + 3 * n);
    for (int d = 0; d < topology.depth[n]; ++d) {
      Vec(x + 3 * topology.path[n][d]).noalias() -= factor.lower[n][d].transpose() * xn;
    }
  }
}

inline void SolveDiagonal(const Topology& topology, const Factor& factor, double* x) {
  for (int n = 0; n < topology.num_nodes; ++n) {
    Vec(x + 3 * n) = (factor.inverse[n] * Vec(x + 3 * n)).eval();
  }
}

/// x = L^-1 x, from the root to the leaves.
inline void SolveDown(const Topology& topology, const Factor& factor, double* x) {
  for (int n = 1; n < topology.num_nodes; ++n) {
    V3 xn = Vec(x + 3 * n);
    for (int d = 0; d < topology.depth[n]; ++d) {
      xn.noalias() -= factor.lower[n][d] * Vec(x + 3 * topology.path[n][d]);
    }
    Vec(x + 3 * n) = xn;
  }
}

inline void Solve(const Topology& topology, const Factor& factor, double* x) {
  SolveUp(topology, factor, x);
  SolveDiagonal(topology, factor, x);
  SolveDown(topology, factor, x);
}

}  // namespace poise::physics::POISE_KERNEL_ISA

#endif  // POISE_CORE_PHYSICS_KERNEL_FACTOR_H_
