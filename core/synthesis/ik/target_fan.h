#ifndef POISE_CORE_SYNTHESIS_IK_TARGET_FAN_H_
#define POISE_CORE_SYNTHESIS_IK_TARGET_FAN_H_

#include "core/base/random.h"
#include "core/motion/skeleton.h"
#include "core/synthesis/ik/ik_config.h"

namespace poise::synthesis {

/// The region that targets are drawn from: a fan around the end effector in cylinder coordinates.
/// The cylinder's axis is the vertical through the limb's base; the height counts from the floor.
/// Source: reference sec. 3.3 (the paper does not name the axis).
class TargetFan {
 public:
  TargetFan(const motion::Vec3& limb_base, const motion::Vec3& end_effector, const IkConfig& config)
      : base_(limb_base), end_effector_(end_effector), config_(config) {}

  /// Three draws, always: radius factor, height factor, angle.
  motion::Vec3 Sample(base::Random& random) const;
  /// The point for given factors; At(1, 1, 0) is the end effector.
  motion::Vec3 At(double radius_factor, double height_factor, double angle) const;

 private:
  motion::Vec3 base_;
  motion::Vec3 end_effector_;
  IkConfig config_;
};

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_IK_TARGET_FAN_H_
