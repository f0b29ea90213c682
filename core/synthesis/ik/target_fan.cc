#include "core/synthesis/ik/target_fan.h"

#include <cmath>

namespace poise::synthesis {

motion::Vec3 TargetFan::Sample(base::Random& random) const {
  const double radius_factor = random.Uniform(config_.radius_low, config_.radius_high);
  const double height_factor = random.Uniform(config_.height_low, config_.height_high);
  const double angle = random.Uniform(-config_.angle, config_.angle);
  return At(radius_factor, height_factor, angle);
}

motion::Vec3 TargetFan::At(double radius_factor, double height_factor, double angle) const {
  // The reference's azimuth atan2(x, z) grows from z to x: turning by it is a turn about +Y. In
  // this form factors of 1 and an angle of 0 give the end effector back, but for rounding.
  const double x = end_effector_.x() - base_.x();
  const double z = end_effector_.z() - base_.z();
  const double sine = std::sin(angle), cosine = std::cos(angle);
  return {base_.x() + radius_factor * (x * cosine + z * sine),
          config_.floor_m + height_factor * (end_effector_.y() - config_.floor_m),
          base_.z() + radius_factor * (z * cosine - x * sine)};
}

}  // namespace poise::synthesis
