#ifndef POISE_CORE_MOTION_METRICS_FLOOR_CONTACT_H_
#define POISE_CORE_MOTION_METRICS_FLOOR_CONTACT_H_

#include "core/motion/metrics/placed_bodies.h"
#include "core/motion/metrics/plausibility.h"

namespace poise::motion {

/// How the bodies of a clip meet the floor.
struct FloorContact {
  double floor_height_m = 0;  ///< world height of the floor, estimated from the motion
  double foot_skate_mps = 0;
  double penetration_mean_m = 0;
  double penetration_max_m = 0;
  double float_mean_m = 0;
};

/// The floor is the median height of each foot's lowest sole corner over the frames in which that
/// corner is still (slower than still_speed_mps) and near (within floor_band_m of) the lowest ones,
/// where "the lowest ones" is the 5 % quantile of the lower foot's height; without any still corner
/// the floor is that quantile. So neither a jump nor a few frames of penetration move it.
/// Foot skating is the mean horizontal speed of each foot's lowest sole corner, weighted by
/// 2 - 2^(height / contact_height_m) between the floor and contact_height_m (1 below the floor, 0
/// above).
/// Source: the weight is that of Zhang et al. 2018 (mode-adaptive networks), sec. 8.
/// Preconditions: at least 3 frames.
FloorContact MeasureFloorContact(const PlacedBodies& bodies, double frame_rate,
                                 const PlausibilityConfig& config);

/// The same against a floor at a known height.
FloorContact MeasureContactWithFloor(const PlacedBodies& bodies, double frame_rate,
                                     double floor_height_m, const PlausibilityConfig& config);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_METRICS_FLOOR_CONTACT_H_
