#ifndef POISE_CORE_ENGINE_FORECASTER_H_
#define POISE_CORE_ENGINE_FORECASTER_H_

#include "core/api/predict_query.h"
#include "core/artifacts/artifact_store.h"
#include "core/base/run_context.h"
#include "core/base/thread_pool.h"
#include "core/pipeline/live_forecast.h"
#include "core/runtime/serving/predictor_catalog.h"

namespace poise::engine {

/// A stream under way, with the model that answers it.
struct ForecastStream {
  std::string model;
  std::string version;
  pipeline::LiveForecast live;
};

/// Answers what comes next, by whatever model is asked for.
/// Threads: all members may be called from any thread.
class Forecaster {
 public:
  /// All but the config outlive the forecaster.
  Forecaster(artifacts::ArtifactStore& artifacts, const artifacts::ModelRegistry& models,
             const serving::ServingConfig& config, base::Telemetry& telemetry)
      : artifacts_(artifacts),
        catalog_(models, config, telemetry),
        threads_(config.max_requests + kSpareThreads) {}

  /// Where the members below are to be called: threads that may wait for others, so that requests
  /// to a model can be answered together, and enough of them that some are left to refuse.
  base::ThreadPool& threads() { return threads_; }

  /// Errors: those of PredictQuery::Validate, PredictorCatalog::Find, LoadGate::Enter,
  /// ClipCatalog::Resolve (field "source") and prediction::Forecast.
  StatusOr<api::Forecast> Predict(api::PredictQuery query, const base::RunContext& context);

  /// A stream is refused like a request, but once begun it holds no place. Errors: those of
  /// PredictorCatalog::Find, LoadGate::Enter and LiveForecast::Create.
  StatusOr<ForecastStream> Open(const api::ForecastStreamSpec& spec);

 private:
  static constexpr int kSpareThreads = 16;

  artifacts::ArtifactStore& artifacts_;
  serving::PredictorCatalog catalog_;
  base::ThreadPool threads_;
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_FORECASTER_H_
