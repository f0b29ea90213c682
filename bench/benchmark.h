#ifndef POISE_BENCH_BENCHMARK_H_
#define POISE_BENCH_BENCHMARK_H_

#include <string>
#include <vector>

#include "bench/measure_rate.h"
#include "core/base/isa.h"

namespace poise::bench {

/// One measured number beside what it is compared with.
struct Row {
  std::string name;  ///< "ik/variants"
  double value = 0;
  std::string unit;  ///< "variants/s"
  std::string peer;  ///< what the value is held against: a stated limit or another implementation
  double ratio = 0;  ///< value / peer's value; above 1 is better than the peer
  int threads = 1;
  std::string isa = base::IsaName(base::BestIsa());
};

/// A group of benchmarks: chosen by name with --filter.
struct Benchmark {
  const char* name;
  std::vector<Row> (*run)();
};

/// All of them, one line each.
const std::vector<Benchmark>& Benchmarks();

std::vector<Row> RunBlasBenchmark();
std::vector<Row> RunCorrectionBenchmark();
std::vector<Row> RunGrpcBenchmark();
std::vector<Row> RunIkBenchmark();
std::vector<Row> RunJobsBenchmark();
std::vector<Row> RunPolicyBenchmark();
std::vector<Row> RunPredictBenchmark();
std::vector<Row> RunPushBenchmark();
std::vector<Row> RunSimBenchmark();
std::vector<Row> RunStreamBenchmark();

}  // namespace poise::bench

#endif  // POISE_BENCH_BENCHMARK_H_
