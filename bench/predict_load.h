#ifndef POISE_BENCH_PREDICT_LOAD_H_
#define POISE_BENCH_PREDICT_LOAD_H_

#include <grpcpp/channel.h>

#include <memory>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "core/motion/clip.h"

namespace poise::bench {

/// What clients saw together.
struct LoadResult {
  double seconds = 0;
  double client_cpu_s = 0;  ///< processor time of the threads that asked
  int64_t answered = 0;
  int64_t refused = 0;  ///< RESOURCE_EXHAUSTED with a retry time, which the client kept to
  int64_t failed = 0;   ///< everything else
  std::string first_failure;
  std::vector<double> latencies_ms;  ///< of answered calls, sorted
  std::vector<double> refusals_ms;   ///< of refused ones, sorted

  double rate() const { return static_cast<double>(answered) / seconds; }
};

/// Value below which a share of sorted values lies; 0 for none.
double Quantile(const std::vector<double>& sorted, double share);

/// A connection that no other channel shares.
std::shared_ptr<grpc::Channel> OwnChannel(const std::string& address);

/// `clients` clients with a connection each, who ask for the future of `past` and, answered, ask
/// again; a refused one waits as long as it was told.
LoadResult RunLoad(const std::string& address, const std::string& model, const motion::Clip& past,
                   double horizon_s, int clients, absl::Duration duration);

}  // namespace poise::bench

#endif  // POISE_BENCH_PREDICT_LOAD_H_
