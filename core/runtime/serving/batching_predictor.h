#ifndef POISE_CORE_RUNTIME_SERVING_BATCHING_PREDICTOR_H_
#define POISE_CORE_RUNTIME_SERVING_BATCHING_PREDICTOR_H_

#include <condition_variable>
#include <list>
#include <memory>
#include <mutex>
#include <vector>

#include "core/base/telemetry.h"
#include "core/prediction/predictor.h"
#include "core/runtime/serving/serving_config.h"

namespace poise::serving {

/// A predictor that answers requests made at the same time together: who finds an executor free
/// runs at once, alone; who does not waits, and the first whose turn comes takes all who wait along
/// into one forward pass, on its own thread. There is no thread and no timer besides, so a lone
/// request pays nothing. Answers are those of the wrapped predictor to 1e-5.
///
/// A request that is cancelled or late while it waits is not computed; one that makes the pass fail
/// fails alone.
/// Threads: Predict blocks its thread; call it from as many as requests shall be merged.
class BatchingPredictor : public prediction::Predictor {
 public:
  /// `telemetry` outlives the predictor.
  BatchingPredictor(std::shared_ptr<const prediction::Predictor> predictor,
                    const ServingConfig& config, base::Telemetry& telemetry,
                    const base::Labels& labels);

  const prediction::PredictorSignature& signature() const override {
    return predictor_->signature();
  }
  /// Errors: those of the wrapped predictor.
  StatusOr<std::vector<motion::Clip>> Predict(std::span<const prediction::Observation> batch,
                                              int future_frames,
                                              const base::RunContext& context) const override;

 private:
  using Answer = StatusOr<std::vector<motion::Clip>>;

  // A call of Predict, on the stack of its thread.
  struct Request {
    std::span<const prediction::Observation> observations;
    int future_frames;
    const base::RunContext* context;
    absl::Time since;
    bool taken = false;  // into a batch; out of the queue
    bool done = false;   // then the answer is there
    Answer answer = absl::UnknownError("");
    std::condition_variable changed = {};
  };

  // With mutex_ held.
  bool MayLead(const Request& request, absl::Time now) const;
  std::vector<Request*> TakeBatch() const;
  void WakeNext() const;

  void Run(const std::vector<Request*>& requests) const;
  void Compute(const std::vector<Request*>& requests) const;
  Status RunTogether(const std::vector<Request*>& requests) const;
  Answer RunAlone(const Request& request) const;

  const std::shared_ptr<const prediction::Predictor> predictor_;
  const ServingConfig config_;
  const absl::Duration patience_;  // how long a request waits for others
  const int executors_;
  base::Counter& passes_;
  base::Counter& motions_;
  base::Histogram& waits_;

  mutable std::mutex mutex_;
  mutable std::list<Request*> waiting_;  // first come first
  mutable int running_ = 0;              // forward passes
};

}  // namespace poise::serving

#endif  // POISE_CORE_RUNTIME_SERVING_BATCHING_PREDICTOR_H_
