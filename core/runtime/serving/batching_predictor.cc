#include "core/runtime/serving/batching_predictor.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "absl/time/clock.h"
#include "core/base/thread_pool.h"
#include "core/motion/editing/cut.h"

namespace poise::serving {

using motion::Clip;
using prediction::Observation;

namespace {

// Of the longest delay; the rest is for waking up on a busy machine.
constexpr double kPatience = 0.9;

}  // namespace

BatchingPredictor::BatchingPredictor(std::shared_ptr<const prediction::Predictor> predictor,
                                     const ServingConfig& config, base::Telemetry& telemetry,
                                     const base::Labels& labels)
    : predictor_(std::move(predictor)),
      config_(config),
      patience_(kPatience * config.max_added_delay),
      executors_(config.executors > 0 ? config.executors : base::AvailableCpus()),
      passes_(telemetry.counter("poise_predict_batches_total", "Forward passes", labels)),
      motions_(
          telemetry.counter("poise_predict_motions_total", "Motions predicted by them", labels)),
      waits_(telemetry.histogram("poise_predict_wait_seconds",
                                 "Time that requests waited for their forward pass", labels)) {}

BatchingPredictor::Answer BatchingPredictor::Predict(std::span<const Observation> batch,
                                                     int future_frames,
                                                     const base::RunContext& context) const {
  // One bad request must not spoil the batch of others.
  POISE_RETURN_IF_ERROR(prediction::CheckObservations(signature(), batch, future_frames));
  POISE_RETURN_IF_ERROR(context.Check());
  Request request{.observations = batch,
                  .future_frames = future_frames,
                  .context = &context,
                  .since = absl::Now()};
  std::unique_lock lock(mutex_);
  const auto place = waiting_.insert(waiting_.end(), &request);
  while (!request.done) {
    if (request.taken) {
      request.changed.wait(lock);
      continue;
    }
    const absl::Time now = absl::Now();
    if (now >= context.deadline || context.cancellation.cancelled()) {
      waiting_.erase(place);
      WakeNext();
      return context.Check();
    }
    if (!MayLead(request, now)) {
      const absl::Time wake = std::min(context.deadline, request.since + patience_);
      request.changed.wait_until(lock, absl::ToChronoTime(wake));
      continue;
    }
    const std::vector<Request*> requests = TakeBatch();
    ++running_;
    lock.unlock();
    Run(requests);
    lock.lock();
    --running_;
    for (Request* served : requests) {
      served->done = true;
      served->changed.notify_one();
    }
    WakeNext();
  }
  return std::move(request.answer);
}

void BatchingPredictor::WakeNext() const {
  if (!waiting_.empty()) waiting_.front()->changed.notify_one();
}

bool BatchingPredictor::MayLead(const Request& request, absl::Time now) const {
  return running_ < executors_ || now >= request.since + patience_;
}

// Of those who wait the first, as many as one pass may hold; never none.
std::vector<BatchingPredictor::Request*> BatchingPredictor::TakeBatch() const {
  const absl::Time now = absl::Now();
  std::vector<Request*> requests;
  size_t motions = 0;
  while (!waiting_.empty()) {
    Request* request = waiting_.front();
    motions += request->observations.size();
    if (!requests.empty() && motions > static_cast<size_t>(config_.max_batch)) break;
    waiting_.pop_front();
    request->taken = true;
    waits_.Observe(absl::ToDoubleSeconds(now - request->since));
    requests.push_back(request);
  }
  return requests;
}

void BatchingPredictor::Run(const std::vector<Request*>& requests) const {
  // Nothing of ours throws on purpose; but the threads of the others must not wait for ever.
  try {
    Compute(requests);
  } catch (const std::exception& error) {
    for (Request* request : requests) {
      request->answer = base::Internal("UNEXPECTED_EXCEPTION", error.what());
    }
  }
}

void BatchingPredictor::Compute(const std::vector<Request*>& requests) const {
  std::vector<Request*> live;
  for (Request* request : requests) {
    const Status status = request->context->Check();
    if (status.ok()) {
      live.push_back(request);
    } else {
      request->answer = status;
    }
  }
  if (live.size() > 1 && RunTogether(live).ok()) return;
  for (Request* request : live) request->answer = RunAlone(*request);
}

Status BatchingPredictor::RunTogether(const std::vector<Request*>& requests) const {
  std::vector<Observation> observations;
  int future_frames = 0;
  for (const Request* request : requests) {
    observations.insert(observations.end(), request->observations.begin(),
                        request->observations.end());
    future_frames = std::max(future_frames, request->future_frames);
  }
  passes_.Increment();
  motions_.Increment(static_cast<double>(observations.size()));
  POISE_ASSIGN_OR_RETURN(std::vector<Clip> futures,
                         predictor_->Predict(observations, future_frames, {}));
  auto future = futures.begin();
  for (Request* request : requests) {
    std::vector<Clip> own;
    for (size_t i = 0; i < request->observations.size(); ++i, ++future) {
      if (request->future_frames < future_frames) {
        POISE_ASSIGN_OR_RETURN(Clip shorter, motion::Cut(*future, 0, request->future_frames));
        own.push_back(std::move(shorter));
      } else {
        own.push_back(std::move(*future));
      }
    }
    request->answer = std::move(own);
  }
  return absl::OkStatus();
}

BatchingPredictor::Answer BatchingPredictor::RunAlone(const Request& request) const {
  passes_.Increment();
  motions_.Increment(static_cast<double>(request.observations.size()));
  return predictor_->Predict(request.observations, request.future_frames, *request.context);
}

}  // namespace poise::serving
