#ifndef POISE_CORE_CORRECTION_DEBIAS_RIDGE_H_
#define POISE_CORE_CORRECTION_DEBIAS_RIDGE_H_

#include <array>
#include <vector>

#include "core/correction/debias/debias_frames.h"

namespace poise::correction {

/// Frames of one actor.
struct ActorFrames {
  FrameRows inputs;       ///< standardised
  FrameRows corrections;  ///< (frames, kCorrectionWidth)
};

/// What is tried, besides no correction at all.
inline constexpr std::array<double, 7> kL2Candidates = {0.03, 0.1, 0.3, 1, 3, 10, 30};

/// Inputs times weight, plus bias, are corrections.
struct RidgeFit {
  Eigen::MatrixXd weight;   ///< (inputs, kCorrectionWidth)
  Eigen::RowVectorXd bias;  ///< (kCorrectionWidth)
  /// Of actors who were left out: mean over frames and joints of |6D error| / sqrt(2), nearly the
  /// angle [rad], by candidate, and without correction. Empty of one actor alone.
  std::vector<double> left_out_errors;
  double left_out_uncorrected = 0;
};

/// Ridge regression in closed form: the least sum of squared errors plus l2 * frames * |weight|^2.
/// `l2` is one for all outputs.
/// Preconditions: at least one actor with frames; l2 > 0.
RidgeFit FitRidge(const std::vector<ActorFrames>& actors, double l2);

/// The same with the candidate for the root's way, and for each joint, that helps the actors who
/// are left out one at a time most; where none helps, zeros. Precondition: at least two actors.
RidgeFit FitRidgeByActors(const std::vector<ActorFrames>& actors);

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_DEBIAS_RIDGE_H_
