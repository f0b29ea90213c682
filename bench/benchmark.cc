#include "bench/benchmark.h"

namespace poise::bench {

const std::vector<Benchmark>& Benchmarks() {
  static const std::vector<Benchmark> benchmarks = {
      {"blas", RunBlasBenchmark},       {"correction", RunCorrectionBenchmark},
      {"grpc", RunGrpcBenchmark},       {"ik", RunIkBenchmark},
      {"jobs", RunJobsBenchmark},       {"policy", RunPolicyBenchmark},
      {"predict", RunPredictBenchmark}, {"push", RunPushBenchmark},
      {"sim", RunSimBenchmark},         {"stream", RunStreamBenchmark},
  };
  return benchmarks;
}

}  // namespace poise::bench
