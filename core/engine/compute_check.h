#ifndef POISE_CORE_ENGINE_COMPUTE_CHECK_H_
#define POISE_CORE_ENGINE_COMPUTE_CHECK_H_

namespace poise::engine {

/// Whether this machine computes as fast as it should.
struct ComputeCheck {
  double sgemm_gflops_per_core = 0;  ///< [10^9 operations / s] of a matrix product
  bool slow = false;                 ///< LibTorch runs on the wrong BLAS
};

/// Takes some 100 ms.
ComputeCheck CheckCompute();

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_COMPUTE_CHECK_H_
