#include "core/engine/compute_check.h"

#include "core/learning/nn/blas_probe.h"

namespace poise::engine {

ComputeCheck CheckCompute() {
  const double gflops = learning::MeasureSgemmGflops();
  return {.sgemm_gflops_per_core = gflops, .slow = gflops < learning::kFaultySgemmGflops};
}

}  // namespace poise::engine
