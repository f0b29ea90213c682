#ifndef POISE_CORE_MOTION_DISTRIBUTION_MMD_H_
#define POISE_CORE_MOTION_DISTRIBUTION_MMD_H_

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "core/base/config_fields.h"
#include "core/base/random.h"
#include "core/base/status.h"

/// Whether two samples come from one distribution: maximum mean discrepancy (Gretton et al. 2012).
namespace poise::motion {

struct MmdConfig {
  /// unbiased: pairs of a point with itself do not count, and equal distributions give 0 on average
  /// | biased: they do, as in the program of MotionAug's authors; never below 0, and larger for
  /// small samples.
  std::string estimator = "unbiased";
  int permutations = 1000;  ///< [>= 0] for the p-value; 0: none
  /// [> 0] Of a sample x with more points than its y as many as y has are drawn, so often: which
  /// few they are decides much (the authors: 10).
  int draws = 100;

  std::vector<base::Field> Fields();
};

/// Two samples that are compared. Shapes: (points, features)
struct SamplePair {
  Eigen::MatrixXd x, y;
};

struct MmdResult {
  double squared_mmd = 0;  ///< mean over pairs and draws
  /// Share of random re-labellings, each within its pair, that are at least as far apart (the
  /// observed labels count as one): how often so much comes of nothing. Mean over draws; 1 without
  /// permutations.
  double p_value = 1;
};

/// Squared discrepancy, pooled over pairs of samples (folds). The kernel of a pair is the sum of
/// five Gaussians exp(-d^2 / b) with b a quarter, a half, once, twice, four times the mean squared
/// distance of two different points of both samples together.
/// Source: reference sec. 2.9.
/// Errors: kInvalidArgument TOO_FEW_SAMPLES (under two in one of them, or no pair), WRONG_SHAPE;
/// CONFIG_VALUE_OUT_OF_RANGE.
StatusOr<MmdResult> MaximumMeanDiscrepancy(std::span<const SamplePair> pairs,
                                           const MmdConfig& config, base::Random& random);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_DISTRIBUTION_MMD_H_
