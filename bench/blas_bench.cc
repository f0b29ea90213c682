#include "bench/benchmark.h"
#include "core/learning/nn/blas_probe.h"

/// Whether LibTorch found a BLAS worth the name.
namespace poise::bench {

std::vector<Row> RunBlasBenchmark() {
  const double rate = learning::MeasureSgemmGflops();
  return {{.name = "blas/sgemm",
           .value = rate,
           .unit = "GFLOP/s",
           .peer = "50 GFLOP/s, less is a deployment fault",
           .ratio = rate / learning::kFaultySgemmGflops,
           .threads = 1}};
}

}  // namespace poise::bench
