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

/// Asks a predictor about a clip of any body and rate.
///   - Time: the last seconds that the model looks at are sampled at its rate, counted back from
///   the
///     last frame; the future comes at the clip's rate, as many frames as fit in `horizon_s`.
///   - Body: by roles, there and back (body_mapping.h).
/// Errors: kInvalidArgument BAD_HORIZON (not positive, or less than one frame of the clip),
/// HORIZON_TOO_LONG, TOO_FEW_FRAMES (all in seconds); kFailedPrecondition FRAME_RATE_TOO_LOW (the
/// model's frames would be invented: less than 0.4 of its rate), MISSING_ROLES,
/// DEGENERATE_SKELETON; those of Predictor::Predict.
StatusOr<ClipFuture> Forecast(const Predictor& predictor, const motion::Clip& past,
                              const motion::JointMask& visible, const motion::JointRoles& roles,
                              double horizon_s, const base::RunContext& context);

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_FORECAST_H_
