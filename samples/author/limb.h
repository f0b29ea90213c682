#ifndef POISE_SAMPLES_AUTHOR_LIMB_H_
#define POISE_SAMPLES_AUTHOR_LIMB_H_

#include "core/math/rotation.h"

namespace poise::samples {

/// Where a leg or an arm points: the upper bone and how far the hinge (knee, elbow) is bent.
/// All in the world.
struct LimbPose {
  math::Vec3 upper;    ///< unit, along the upper bone
  math::Vec3 hinge;    ///< unit, normal to `upper`; a positive turn about it flexes
  double flexion = 0;  ///< [rad] 0 is straight
  math::Vec3 Lower() const { return Eigen::AngleAxisd(flexion, hinge) * upper; }
};

/// Closed-form inverse kinematics of two bones: the pose that brings the end of the limb from
/// `base` to `goal`, the hinge on the side of `pole` (a direction). A goal out of reach is
/// approached to 0.1 % of the limb's length.
LimbPose ReachGoal(const math::Vec3& base, const math::Vec3& goal, const math::Vec3& pole,
                   double upper_length, double lower_length);

/// From a (weight 0) to b (weight 1).
LimbPose Blend(const LimbPose& a, const LimbPose& b, double weight);

/// World rotation of a bone whose rest pose has the bone along `rest_bone` and the hinge along
/// `rest_hinge` (unit, normal to each other) and that now lie along `bone` and `hinge`.
math::Quat TurnBone(const math::Vec3& rest_bone, const math::Vec3& rest_hinge,
                    const math::Vec3& bone, const math::Vec3& hinge);

}  // namespace poise::samples

#endif  // POISE_SAMPLES_AUTHOR_LIMB_H_
