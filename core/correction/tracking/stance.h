#ifndef POISE_CORE_CORRECTION_TRACKING_STANCE_H_
#define POISE_CORE_CORRECTION_TRACKING_STANCE_H_

#include <array>

#include "core/physics/world.h"

namespace poise::correction {

using math::Vec3;

/// A point where a foot touches the ground.
struct Stance {
  int body = 0;               ///< the foot
  double load = 1;            ///< [> 0] how willingly it carries, against the other points
  Vec3 point = Vec3::Zero();  ///< [m]
  Vec3 force = Vec3::Zero();  ///< [N] that the ground is to exert there
};

/// All of them.
struct Stances {
  static constexpr int kMax = 16;
  int count = 0;
  std::array<Stance, kMax> points;
};

/// `loads`: right and left foot's; see ReferenceMotion::FootLoads. A foot that the motion is
/// lifting hardly carries where the other touches, too: else the weight that it is given holds it
/// down.
Stances FindStances(const physics::World& world, const std::array<double, 2>& loads);

/// How the ground's reaction is shared.
struct StanceLimits {
  double friction = 0.81;
  double moment_softness_m2 = 3e-4;  ///< [m2] moments that only points nearer together than its
                                     ///< root could exert are given up
};

/// Shares a wrench (at `at`, world axes) over the points: damped least squares of their forces,
/// squares divided by the loads; a point that would have to pull is left out; each force is cut to
/// its friction cone. What is cut nobody exerts.
void ShareWrench(const Vec3& at, const Vec3& force, const Vec3& torque, const StanceLimits& limits,
                 Stances& stances);

/// Joint torques with which the body passes these forces on: -J^T, 0 at the root.
physics::Speeds StanceTorques(const physics::Articulation& tree, const physics::BodyFrames& frames,
                              const Stances& stances);

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_TRACKING_STANCE_H_
