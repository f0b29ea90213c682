#ifndef POISE_BENCH_MEASURE_RATE_H_
#define POISE_BENCH_MEASURE_RATE_H_

#include <functional>

namespace poise::bench {

/// Seconds that this thread has computed.
double ThreadSeconds();

/// How often `work` runs in one second of this thread's own computing time, which other processes
/// do not take away: the best of several rounds that last `round_seconds` each, after one to warm
/// up. `work` must not hand its work to other threads.
double MeasureRate(const std::function<void()>& work, double round_seconds = 0.5);

}  // namespace poise::bench

#endif  // POISE_BENCH_MEASURE_RATE_H_
