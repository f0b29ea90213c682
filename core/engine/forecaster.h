#ifndef POISE_CORE_ENGINE_FORECASTER_H_
#define POISE_CORE_ENGINE_FORECASTER_H_

#include "core/api/predict_query.h"
#include "core/artifacts/artifact_store.h"
#include "core/base/run_context.h"
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
  /// Both outlive the forecaster.
  Forecaster(artifacts::ArtifactStore& artifacts, const artifacts::ModelRegistry& models)
      : artifacts_(artifacts), catalog_(models) {}

  /// Errors: those of PredictQuery::Validate, PredictorCatalog::Find, ClipCatalog::Resolve (field
  /// "source") and prediction::Forecast.
  StatusOr<api::Forecast> Predict(api::PredictQuery query, const base::RunContext& context);

  /// Errors: those of PredictorCatalog::Find and LiveForecast::Create.
  StatusOr<ForecastStream> Open(const api::ForecastStreamSpec& spec);

 private:
  artifacts::ArtifactStore& artifacts_;
  serving::PredictorCatalog catalog_;
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_FORECASTER_H_
