#include "core/prediction/forecast.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/motion/editing/cut.h"
#include "core/motion/editing/sample_at.h"
#include "core/prediction/body_mapping.h"

namespace poise::prediction {
namespace {

using motion::Clip;

constexpr double kLowestRate = 0.4;       // of the model's
constexpr double kFrameTolerance = 1e-6;  // [frames] a horizon may miss a frame by
constexpr int kMaxFutureFrames = 100'000;
constexpr int64_t kMaxFutureRotations = 2'000'000;  // 32 MB on the wire

// Frames of the source's rate that lie within the horizon.
StatusOr<int> FutureFrames(double source_rate, double horizon_s) {
  const double frames = std::floor(horizon_s * source_rate + kFrameTolerance);
  if (frames >= 1 && frames <= kMaxFutureFrames) return static_cast<int>(frames);
  return base::InvalidArgument(
      "BAD_HORIZON", "horizon_s",
      fmt::format("a horizon of {} s is {} frames at the source's {} Hz, expected 1 to {}",
                  horizon_s, frames, source_rate, kMaxFutureFrames));
}

Status CheckPast(const PredictorSignature& signature, const Clip& past, const ForecastPlan& plan) {
  if (past.num_frames() >= plan.source_past) return absl::OkStatus();
  return base::InvalidArgument(
      "TOO_FEW_FRAMES", "source",
      fmt::format("the model looks at {} frames at {} Hz, which is {:.3f} s; the clip has {} "
                  "frames, {:.3f} s",
                  signature.past_frames, plan.model_rate,
                  (signature.past_frames - 1) / plan.model_rate, past.num_frames(),
                  past.duration()));
}

// The model's past: its last pose is the clip's last.
StatusOr<Clip> PastAtModelRate(const Clip& past, const PredictorSignature& signature,
                               const ForecastPlan& plan) {
  std::vector<double> places;
  for (int i = 0; i < signature.past_frames; ++i) {
    const int back = signature.past_frames - 1 - i;
    places.push_back(
        std::max(0.0, past.num_frames() - 1 - back * past.frame_rate() / plan.model_rate));
  }
  return motion::SampleAt(past, places, plan.model_rate);
}

// Last observed pose and future of the model, as a clip at the source's rate without the former.
StatusOr<Clip> FutureAtSourceRate(const Clip& last, const Clip& future, double source_rate,
                                  const ForecastPlan& plan) {
  std::vector<motion::Vec3> positions = {last.root_position(last.num_frames() - 1)};
  const auto pose = last.pose(last.num_frames() - 1);
  std::vector<motion::Quat> rotations(pose.begin(), pose.end());
  positions.insert(positions.end(), future.root_positions().begin(), future.root_positions().end());
  rotations.insert(rotations.end(), future.rotations().begin(), future.rotations().end());
  POISE_ASSIGN_OR_RETURN(const Clip joined,
                         Clip::Create(last.name(), last.skeleton(), plan.model_rate,
                                      std::move(positions), std::move(rotations)));
  std::vector<double> places;
  for (int i = 1; i <= plan.source_future; ++i) {
    places.push_back(std::min<double>(i * plan.model_rate / source_rate, plan.model_future));
  }
  return motion::SampleAt(joined, places, source_rate);
}

StatusOr<Clip> PredictOne(const Predictor& predictor, Observation observation, int future_frames,
                          const base::RunContext& context) {
  POISE_ASSIGN_OR_RETURN(std::vector<Clip> futures,
                         predictor.Predict({&observation, 1}, future_frames, context));
  return std::move(futures.front());
}

}  // namespace

StatusOr<ForecastPlan> PlanForecast(const PredictorSignature& signature, double source_rate,
                                    double horizon_s) {
  ForecastPlan plan;
  plan.model_rate = signature.frame_rate > 0 ? signature.frame_rate : source_rate;
  POISE_ASSIGN_OR_RETURN(plan.source_future, FutureFrames(source_rate, horizon_s));
  const double ratio = source_rate / plan.model_rate;
  if (ratio < kLowestRate) {
    return base::FailedPrecondition(
        "FRAME_RATE_TOO_LOW", "source",
        fmt::format("the source has {} frames a second, the model works at {}: more than half of "
                    "what it looks at would be invented",
                    source_rate, plan.model_rate));
  }
  plan.model_future = static_cast<int>(std::ceil(plan.source_future / ratio - kFrameTolerance));
  if (signature.max_future_frames > 0 && plan.model_future > signature.max_future_frames) {
    return base::InvalidArgument(
        "HORIZON_TOO_LONG", "horizon_s",
        fmt::format("a horizon of {:.3f} s asked for, the model sees {:.3f} s ahead", horizon_s,
                    signature.max_future_frames / plan.model_rate));
  }
  plan.source_past =
      static_cast<int>(std::ceil((signature.past_frames - 1) * ratio - kFrameTolerance)) + 1;
  return plan;
}

StatusOr<ClipFuture> Forecast(const Predictor& predictor, const Clip& past,
                              const motion::JointMask& visible, const motion::JointRoles& roles,
                              double horizon_s, const base::RunContext& context) {
  const PredictorSignature& signature = predictor.signature();
  POISE_ASSIGN_OR_RETURN(const ForecastPlan plan,
                         PlanForecast(signature, past.frame_rate(), horizon_s));
  POISE_RETURN_IF_ERROR(CheckPast(signature, past, plan));
  if (int64_t{plan.source_future} * past.num_joints() > kMaxFutureRotations) {
    return base::InvalidArgument(
        "REQUEST_TOO_LARGE", "horizon_s",
        fmt::format("{} future frames of {} joints, at most {} rotations", plan.source_future,
                    past.num_joints(), kMaxFutureRotations));
  }
  ClipFuture result{.clip = past, .times_s = {}};
  for (int i = 1; i <= plan.source_future; ++i) result.times_s.push_back(i / past.frame_rate());
  if (signature.frame_rate == 0 && signature.skeleton == nullptr) {
    POISE_ASSIGN_OR_RETURN(result.clip,
                           PredictOne(predictor, {past, visible}, plan.source_future, context));
    return result;
  }
  if (!visible.empty() && !signature.takes_masks) {
    return base::InvalidArgument("MASKS_NOT_SUPPORTED", "visible",
                                 "this model needs every joint of every frame");
  }
  POISE_ASSIGN_OR_RETURN(Clip sampled, PastAtModelRate(past, signature, plan));
  POISE_ASSIGN_OR_RETURN(
      const BodyMapping mapping,
      BodyMapping::Create(std::move(sampled), roles,
                          signature.skeleton ? signature.skeleton : past.skeleton()));
  POISE_ASSIGN_OR_RETURN(const Clip future, PredictOne(predictor, {mapping.on_model(), {}},
                                                       plan.model_future, context));
  POISE_ASSIGN_OR_RETURN(const Clip timed,
                         FutureAtSourceRate(mapping.on_model(), future, past.frame_rate(), plan));
  POISE_ASSIGN_OR_RETURN(result.clip, mapping.Back(timed));
  return result;
}

}  // namespace poise::prediction
