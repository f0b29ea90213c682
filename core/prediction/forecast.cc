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
constexpr int64_t kMaxFutureFrames = 100'000;

// Frames of the clip's rate that lie within the horizon.
StatusOr<int> FutureFrames(const Clip& past, double horizon_s) {
  const double frames = std::floor(horizon_s * past.frame_rate() + kFrameTolerance);
  if (frames >= 1 && frames <= kMaxFutureFrames) return static_cast<int>(frames);
  return base::InvalidArgument(
      "BAD_HORIZON", "horizon_s",
      fmt::format("a horizon of {} s is {} frames at the clip's {} Hz, expected 1 to {}", horizon_s,
                  frames, past.frame_rate(), kMaxFutureFrames));
}

// How the clip's frames and the model's lie to each other.
struct Rates {
  double model;        // [Hz]
  int source_future;   // frames
  int model_future;    // frames that reach at least as far
  double source_past;  // frames of the source between the first and the last pose looked at
};

StatusOr<Rates> MatchRates(const PredictorSignature& signature, const Clip& past,
                           double horizon_s) {
  Rates rates{.model = signature.frame_rate > 0 ? signature.frame_rate : past.frame_rate(),
              .source_future = 0,
              .model_future = 0,
              .source_past = 0};
  POISE_ASSIGN_OR_RETURN(rates.source_future, FutureFrames(past, horizon_s));
  const double ratio = past.frame_rate() / rates.model;
  if (ratio < kLowestRate) {
    return base::FailedPrecondition(
        "FRAME_RATE_TOO_LOW", "source",
        fmt::format("the clip has {} frames a second, the model works at {}: more than half of "
                    "what it looks at would be invented",
                    past.frame_rate(), rates.model));
  }
  rates.model_future = static_cast<int>(std::ceil(rates.source_future / ratio - kFrameTolerance));
  if (signature.max_future_frames > 0 && rates.model_future > signature.max_future_frames) {
    return base::InvalidArgument(
        "HORIZON_TOO_LONG", "horizon_s",
        fmt::format("a horizon of {:.3f} s asked for, the model sees {:.3f} s ahead", horizon_s,
                    signature.max_future_frames / rates.model));
  }
  rates.source_past = (signature.past_frames - 1) * ratio;
  if (rates.source_past > past.num_frames() - 1 + kFrameTolerance) {
    return base::InvalidArgument(
        "TOO_FEW_FRAMES", "source",
        fmt::format("the model looks at {} frames at {} Hz, which is {:.3f} s; the clip has {} "
                    "frames, {:.3f} s",
                    signature.past_frames, rates.model, (signature.past_frames - 1) / rates.model,
                    past.num_frames(), past.duration()));
  }
  return rates;
}

// The model's past: its last pose is the clip's last.
StatusOr<Clip> PastAtModelRate(const Clip& past, const PredictorSignature& signature,
                               const Rates& rates) {
  std::vector<double> places;
  for (int i = 0; i < signature.past_frames; ++i) {
    const int back = signature.past_frames - 1 - i;
    places.push_back(std::max(0.0, past.num_frames() - 1 - back * past.frame_rate() / rates.model));
  }
  return motion::SampleAt(past, places, rates.model);
}

// Last observed pose and future of the model, as a clip at the source's rate without the former.
StatusOr<Clip> FutureAtSourceRate(const Clip& last, const Clip& future, double source_rate,
                                  const Rates& rates) {
  std::vector<motion::Vec3> positions = {last.root_position(last.num_frames() - 1)};
  const auto pose = last.pose(last.num_frames() - 1);
  std::vector<motion::Quat> rotations(pose.begin(), pose.end());
  positions.insert(positions.end(), future.root_positions().begin(), future.root_positions().end());
  rotations.insert(rotations.end(), future.rotations().begin(), future.rotations().end());
  POISE_ASSIGN_OR_RETURN(const Clip joined,
                         Clip::Create(last.name(), last.skeleton(), rates.model,
                                      std::move(positions), std::move(rotations)));
  std::vector<double> places;
  for (int i = 1; i <= rates.source_future; ++i) {
    places.push_back(std::min<double>(i * rates.model / source_rate, rates.model_future));
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

StatusOr<ClipFuture> Forecast(const Predictor& predictor, const Clip& past,
                              const motion::JointMask& visible, const motion::JointRoles& roles,
                              double horizon_s, const base::RunContext& context) {
  const PredictorSignature& signature = predictor.signature();
  POISE_ASSIGN_OR_RETURN(const Rates rates, MatchRates(signature, past, horizon_s));
  ClipFuture result{.clip = past, .times_s = {}};
  for (int i = 1; i <= rates.source_future; ++i) result.times_s.push_back(i / past.frame_rate());
  if (signature.frame_rate == 0 && signature.skeleton == nullptr) {
    POISE_ASSIGN_OR_RETURN(result.clip,
                           PredictOne(predictor, {past, visible}, rates.source_future, context));
    return result;
  }
  if (!visible.empty() && !signature.takes_masks) {
    return base::InvalidArgument("MASKS_NOT_SUPPORTED", "visible",
                                 "this model needs every joint of every frame");
  }
  POISE_ASSIGN_OR_RETURN(Clip sampled, PastAtModelRate(past, signature, rates));
  POISE_ASSIGN_OR_RETURN(
      const BodyMapping mapping,
      BodyMapping::Create(std::move(sampled), roles,
                          signature.skeleton ? signature.skeleton : past.skeleton()));
  POISE_ASSIGN_OR_RETURN(const Clip future, PredictOne(predictor, {mapping.on_model(), {}},
                                                       rates.model_future, context));
  POISE_ASSIGN_OR_RETURN(const Clip timed,
                         FutureAtSourceRate(mapping.on_model(), future, past.frame_rate(), rates));
  POISE_ASSIGN_OR_RETURN(result.clip, mapping.Back(timed));
  return result;
}

}  // namespace poise::prediction
