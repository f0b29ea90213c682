#ifndef POISE_BENCH_PREDICT_SETUP_H_
#define POISE_BENCH_PREDICT_SETUP_H_

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "core/artifacts/model_artifact.h"
#include "core/prediction/predictor_registry.h"
#include "server/server.h"

namespace poise::bench {

/// What the benchmarks of predictions ask, and whom: the shipped predictor.
inline constexpr char kPredictModel[] = "predictor-cmu";
inline constexpr int kPredictFrames = 24;  ///< of the future

/// Times POISE_BENCH_SCALE (1).
absl::Duration Scaled(absl::Duration time);

/// Resident memory of this process [MB].
double MemoryMb();

template <typename Value>
Value OrDie(StatusOr<Value> value) {
  if (value.ok()) return *std::move(value);
  fmt::print(stderr, "predict: {}\n", base::Message(value.status()));
  std::abort();
}

/// Keeps how long requests waited for their forward pass.
class WaitRecorder : public base::Telemetry, public base::Histogram {
 public:
  base::Histogram& histogram(const std::string& name, const std::string& help,
                             const base::Labels& labels) override;
  void Observe(double value) override;
  std::vector<double> TakeSorted();  ///< [ms]

 private:
  std::mutex mutex_;
  std::vector<double> waits_ms_;
};

/// A server with the shipped models, in this process.
struct Service {
  Service(const std::string& name, const serving::ServingConfig& config);
  ~Service();
  const std::string& address() const { return server->address(); }

  std::filesystem::path folder;
  WaitRecorder telemetry;
  std::unique_ptr<engine::Engine> engine;
  std::unique_ptr<server::Server> server;
};

struct Subject {
  artifacts::ModelArtifact model;
  prediction::PredictorPtr predictor;
  motion::Clip past;  // as long as the model looks at
  double horizon_s;
};

Subject ReadSubject();

}  // namespace poise::bench

#endif  // POISE_BENCH_PREDICT_SETUP_H_
