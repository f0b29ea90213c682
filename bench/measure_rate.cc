#include "bench/measure_rate.h"

#include <time.h>

#include <algorithm>
#include <cstdint>

namespace poise::bench {
namespace {

constexpr int kRounds = 5;

double OneRound(const std::function<void()>& work, double seconds) {
  const double start = ThreadSeconds();
  int64_t runs = 0;
  double elapsed = 0;
  while (elapsed < seconds) {
    work();
    ++runs;
    elapsed = ThreadSeconds() - start;
  }
  return static_cast<double>(runs) / elapsed;
}

}  // namespace

double ThreadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double MeasureRate(const std::function<void()>& work, double round_seconds) {
  OneRound(work, round_seconds);
  double best = 0;
  for (int round = 0; round < kRounds; ++round)
    best = std::max(best, OneRound(work, round_seconds));
  return best;
}

}  // namespace poise::bench
