#ifndef POISE_CORE_PREDICTION_FORECAST_H_
#define POISE_CORE_PREDICTION_FORECAST_H_

#include <vector>

#include "core/motion/joint_roles.h"
#include "core/prediction/predictor.h"

namespace poise::prediction {

/// The future of one clip on its own body and at its own rate.
struct ClipFuture {
  motion::Clip clip;
  std::vector<double> times_s;  ///< (frames) [s] after the last observed frame
};

/// How a model's frames and those of a source lie to each other.
struct ForecastPlan {
  double model_rate = 0;  ///< [Hz]
  int source_future = 0;  ///< frames of the source's rate that fit in the horizon
  int model_future = 0;   ///< frames of the model's that reach as far
  int source_past = 0;    ///< frames of the source that are looked at
};

/// Errors: kInvalidArgument BAD_HORIZON (not positive, or less than one frame of the source),
/// HORIZON_TOO_LONG; kFailedPrecondition FRAME_RATE_TOO_LOW (less than 0.4 of the model's: most of
/// what the model looks at would be invented).
StatusOr<ForecastPlan> PlanForecast(const PredictorSignature& signature, double source_rate,
                                    double horizon_s);

/// Asks a predictor about a clip of any body and rate.
///   - Time: the last seconds that the model looks at are sampled at its rate, counted back from
///   the
///     last frame; the future comes at the clip's rate, as many frames as fit in `horizon_s`.
///   - Body: by roles, there and back (body_mapping.h).
/// Errors: those of PlanForecast and Predictor::Predict; kInvalidArgument TOO_FEW_FRAMES,
/// REQUEST_TOO_LARGE, MASKS_NOT_SUPPORTED; kFailedPrecondition MISSING_ROLES, DEGENERATE_SKELETON.
StatusOr<ClipFuture> Forecast(const Predictor& predictor, const motion::Clip& past,
                              const motion::JointMask& visible, const motion::JointRoles& roles,
                              double horizon_s, const base::RunContext& context);

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_FORECAST_H_
