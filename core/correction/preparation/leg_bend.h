#ifndef POISE_CORE_CORRECTION_PREPARATION_LEG_BEND_H_
#define POISE_CORE_CORRECTION_PREPARATION_LEG_BEND_H_

#include "core/correction/preparation/foot_track.h"

namespace poise::correction {

/// Where a foot is to be.
struct FootTarget {
  Vec3 ankle = Vec3::Zero();         ///< [m]
  Quat rotation = Quat::Identity();  ///< world from foot
};

/// How far the hip must sink so that the leg reaches the target [m]; 0 when it does.
double DropToReach(const motion::Clip& clip, int frame, const FootTrack& foot, const Vec3& ankle);

/// Turns hip and knee by the smallest rotations that bring the ankle to its target (as near as the
/// leg reaches), and gives the foot its rotation.
void BendLeg(const FootTarget& target, int frame, const FootTrack& foot, motion::Clip& clip);

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_PREPARATION_LEG_BEND_H_
