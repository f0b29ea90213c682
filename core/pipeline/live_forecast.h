#ifndef POISE_CORE_PIPELINE_LIVE_FORECAST_H_
#define POISE_CORE_PIPELINE_LIVE_FORECAST_H_

#include <memory>
#include <optional>

#include "core/api/predict_query.h"
#include "core/base/run_context.h"
#include "core/motion/joint_roles.h"
#include "core/prediction/forecast.h"

namespace poise::pipeline {

/// A stream of frames with a forecast after the last of them whenever it is wanted: keeps as much
/// of the past as the model looks at. Threads: one caller at a time.
class LiveForecast {
 public:
  /// Errors: those of ForecastStreamSpec::Validate, PlanForecast and JointRoles::Detect.
  static StatusOr<LiveForecast> Create(std::shared_ptr<const prediction::Predictor> predictor,
                                       const api::ForecastStreamSpec& spec);

  /// Adds frames of the stream's skeleton and rate.
  void Observe(const motion::Clip& frames);
  int64_t observed_frames() const { return observed_frames_; }

  /// The future after the last frame; nullopt while too few have come. Errors: those of Forecast.
  StatusOr<std::optional<prediction::ClipFuture>> Next(const base::RunContext& context) const;

 private:
  LiveForecast(std::shared_ptr<const prediction::Predictor> predictor,
               const api::ForecastStreamSpec& spec, motion::JointRoles roles,
               const prediction::ForecastPlan& plan)
      : predictor_(std::move(predictor)), spec_(spec), roles_(std::move(roles)), plan_(plan) {}

  std::shared_ptr<const prediction::Predictor> predictor_;
  api::ForecastStreamSpec spec_;
  motion::JointRoles roles_;
  prediction::ForecastPlan plan_;
  int64_t observed_frames_ = 0;
  std::vector<motion::Vec3> positions_;  // (frames), at most plan_.source_past
  std::vector<motion::Quat> rotations_;  // (frames, joints)
};

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_LIVE_FORECAST_H_
