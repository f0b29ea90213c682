#include "core/pipeline/live_forecast.h"

#include <algorithm>

namespace poise::pipeline {

StatusOr<LiveForecast> LiveForecast::Create(std::shared_ptr<const prediction::Predictor> predictor,
                                            const api::ForecastStreamSpec& spec) {
  POISE_RETURN_IF_ERROR(spec.Validate());
  POISE_ASSIGN_OR_RETURN(
      const prediction::ForecastPlan plan,
      prediction::PlanForecast(predictor->signature(), spec.frame_rate, spec.horizon_s));
  POISE_ASSIGN_OR_RETURN(motion::JointRoles roles,
                         motion::JointRoles::Detect(*spec.skeleton, spec.joint_roles));
  if (predictor->signature().skeleton != nullptr) POISE_RETURN_IF_ERROR(roles.RequireComplete());
  return LiveForecast(std::move(predictor), spec, std::move(roles), plan);
}

void LiveForecast::Observe(const motion::Clip& frames) {
  observed_frames_ += frames.num_frames();
  const int joints = frames.num_joints();
  positions_.insert(positions_.end(), frames.root_positions().begin(),
                    frames.root_positions().end());
  rotations_.insert(rotations_.end(), frames.rotations().begin(), frames.rotations().end());
  const int surplus = std::max(0, static_cast<int>(positions_.size()) - plan_.source_past);
  positions_.erase(positions_.begin(), positions_.begin() + surplus);
  rotations_.erase(rotations_.begin(), rotations_.begin() + static_cast<int64_t>(surplus) * joints);
}

StatusOr<std::optional<prediction::ClipFuture>> LiveForecast::Next(
    const base::RunContext& context) const {
  if (static_cast<int>(positions_.size()) < plan_.source_past) {
    return std::optional<prediction::ClipFuture>();
  }
  POISE_ASSIGN_OR_RETURN(
      const motion::Clip past,
      motion::Clip::Create("stream", spec_.skeleton, spec_.frame_rate, positions_, rotations_));
  POISE_ASSIGN_OR_RETURN(
      prediction::ClipFuture future,
      prediction::Forecast(*predictor_, past, {}, roles_, spec_.horizon_s, context));
  return std::optional<prediction::ClipFuture>(std::move(future));
}

}  // namespace poise::pipeline
