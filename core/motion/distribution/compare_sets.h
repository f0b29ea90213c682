#ifndef POISE_CORE_MOTION_DISTRIBUTION_COMPARE_SETS_H_
#define POISE_CORE_MOTION_DISTRIBUTION_COMPARE_SETS_H_

#include <vector>

#include "core/base/config_fields.h"
#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/motion/distribution/mmd.h"
#include "core/motion/distribution/motion_features.h"

namespace poise::motion {

struct CompareConfig {
  MmdConfig mmd;
  /// [motions] of the made and of the training ones that the nearest is looked for in, mean over
  /// all such subsets: more find a nearer one. 0: as many as the smaller of both has.
  int nearest_of = 0;

  std::vector<base::Field> Fields();
};

/// Motions that were made, and what they are held against.
struct MotionSets {
  std::vector<MotionFeatures> made;
  std::vector<MotionFeatures> training;   ///< what they were made from
  std::vector<MotionFeatures> reference;  ///< what they should be like: of people not learned from
};

/// What a set of made motions is like (reference sec. 2.9 and 2.10). Distances are DTW [rad].
struct SetComparison {
  double mmd = 0;               ///< squared, between as many made as reference motions
  double mmd_p = 1;             ///< of its permutation test
  double mmd_training = 0;      ///< the same between training and reference motions
  int nearest_of = 0;           ///< size of the sets for min_dtw
  double min_dtw = 0;           ///< mean over reference motions to the nearest made one
  double min_dtw_training = 0;  ///< to the nearest training motion
  double diversity = 0;         ///< mean over pairs of made motions
  double diversity_training = 0;
  double novelty = 0;        ///< mean over made motions to the nearest training motion
  double novelty_least = 0;  ///< of the made motion that is nearest to one
  double mean_speed_mps = 0;
  double mean_speed_training_mps = 0;
  double foot_skate_mps = 0;
  double foot_skate_training_mps = 0;
  /// Share of made motions under half as long as the shortest, or over twice as long as the longest
  /// training motion.
  double odd_lengths = 0;

  /// By name, in this order.
  std::vector<base::Field> Fields();
};

/// The descriptors of both: a fold of MaximumMeanDiscrepancy. Precondition: none is empty.
SamplePair DescriptorPair(const std::vector<MotionFeatures>& motions,
                          const std::vector<MotionFeatures>& reference);

/// Draws with the seed of `context`.
/// Errors: kInvalidArgument TOO_FEW_MOTIONS naming the set (under two); CONFIG_VALUE_OUT_OF_RANGE;
/// kCancelled, kDeadlineExceeded.
StatusOr<SetComparison> CompareSets(const MotionSets& sets, const CompareConfig& config,
                                    const base::RunContext& context);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_DISTRIBUTION_COMPARE_SETS_H_
