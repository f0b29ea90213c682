#include "core/api/predict_query.h"

#include <fmt/format.h>

namespace poise::api {
namespace {

Status CheckModelAndHorizon(const std::string& model, double horizon_s) {
  if (model.empty()) {
    return base::InvalidArgument("BAD_MODEL_NAME", "model",
                                 "no model named, expected NAME or NAME@VERSION");
  }
  if (!(horizon_s > 0 && horizon_s <= PredictQuery::kMaxHorizon)) {
    return base::InvalidArgument("BAD_HORIZON", "horizon_s",
                                 fmt::format("horizon is {} s, expected above 0 and at most {}",
                                             horizon_s, PredictQuery::kMaxHorizon));
  }
  return absl::OkStatus();
}

}  // namespace

Status PredictQuery::Validate() const {
  POISE_RETURN_IF_ERROR(CheckModelAndHorizon(model, horizon_s));
  if (samples >= 1 && samples <= kMaxSamples) return absl::OkStatus();
  return base::InvalidArgument("BAD_SAMPLE_COUNT", "samples",
                               fmt::format("{} samples, expected 1 to {}", samples, kMaxSamples));
}

Status ForecastStreamSpec::Validate() const {
  POISE_RETURN_IF_ERROR(CheckModelAndHorizon(model, horizon_s));
  if (frame_rate > 0 && frame_rate <= motion::Clip::kMaxFrameRate) return absl::OkStatus();
  return base::InvalidArgument("BAD_FRAME_RATE", "frame_rate",
                               fmt::format("frame rate is {} Hz, expected (0, {}]", frame_rate,
                                           motion::Clip::kMaxFrameRate));
}

}  // namespace poise::api
