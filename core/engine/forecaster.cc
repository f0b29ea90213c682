#include "core/engine/forecaster.h"

#include <optional>
#include <utility>

#include "core/engine/clip_catalog.h"

namespace poise::engine {
namespace {

api::EncodedClip AsBvh(const motion::Clip& clip, const motion::SourceConvention& convention) {
  return {.name = clip.name() + ".bvh",
          .data = motion::EncodeBvh(clip, convention),
          .format = motion::ClipFormat::kBvh,
          .skeleton_data = "",
          .hints = {}};
}

// Floors cost too little to be refused.
StatusOr<std::optional<serving::LoadGate::Place>> Enter(const serving::ServedPredictor& served) {
  std::optional<serving::LoadGate::Place> place;
  if (served.gate == nullptr) return place;
  POISE_ASSIGN_OR_RETURN(serving::LoadGate::Place taken, served.gate->Enter());
  place.emplace(std::move(taken));
  return place;
}

}  // namespace

StatusOr<api::Forecast> Forecaster::Predict(api::PredictQuery query,
                                            const base::RunContext& context) {
  POISE_RETURN_IF_ERROR(query.Validate());
  POISE_ASSIGN_OR_RETURN(const serving::ServedPredictor served, catalog_.Find(query.model));
  POISE_ASSIGN_OR_RETURN(const auto place, Enter(served));
  const StatusOr<CatalogClip> source = ClipCatalog(artifacts_).Resolve(std::move(query.source));
  if (!source.ok()) return base::Annotate(source.status(), "source", "source");
  POISE_ASSIGN_OR_RETURN(prediction::ClipFuture future,
                         prediction::Forecast(*served.predictor, source->source.clip, query.visible,
                                              source->source.roles, query.horizon_s, context));
  api::Forecast forecast{.model = served.name,
                         .version = served.version,
                         .frame_times_s = std::move(future.times_s),
                         .futures = {},
                         .inpainted = !query.visible.empty()};
  if (query.output == api::OutputEncoding::kBvh) {
    forecast.futures.emplace_back(AsBvh(future.clip, FileConvention(*source)));
  } else {
    forecast.futures.emplace_back(std::move(future.clip));
  }
  return forecast;
}

StatusOr<ForecastStream> Forecaster::Open(const api::ForecastStreamSpec& spec) {
  POISE_ASSIGN_OR_RETURN(serving::ServedPredictor served, catalog_.Find(spec.model));
  POISE_RETURN_IF_ERROR(Enter(served).status());
  POISE_ASSIGN_OR_RETURN(pipeline::LiveForecast live,
                         pipeline::LiveForecast::Create(std::move(served.predictor), spec));
  return ForecastStream{std::move(served.name), std::move(served.version), std::move(live)};
}

}  // namespace poise::engine
