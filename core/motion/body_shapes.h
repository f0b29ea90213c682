#ifndef POISE_CORE_MOTION_BODY_SHAPES_H_
#define POISE_CORE_MOTION_BODY_SHAPES_H_

#include <array>
#include <optional>

#include "core/motion/joint_roles.h"

namespace poise::motion {

enum class ShapeKind { kSphere, kCapsule, kBox };

/// One rigid body of a person: a simple shape that moves with a joint.
/// Frames: center and orientation are given in the joint's frame. A capsule lies along the shape's
/// own Y; a box has its length (heel to toe) along X, its thickness along Y (sole to instep) and
/// its width along Z.
struct BodyShape {
  JointRole role{};  ///< of the joint that carries it
  int joint = 0;
  int parent = -1;  ///< index of the body that it hangs off; -1 for the pelvis
  ShapeKind kind = ShapeKind::kSphere;
  double radius = 0;                    ///< [m] sphere and capsule
  double half_length = 0;               ///< [m] capsule: from centre to centre of a cap
  Vec3 half_extents = Vec3::Zero();     ///< [m] box
  Vec3 center = Vec3::Zero();           ///< [m]
  Quat orientation = Quat::Identity();  ///< joint from shape
};

/// The 16 bodies, one per required role and in that order.
using BodyShapes = std::array<BodyShape, kNumRequiredRoles>;

/// How a foot stands: in the ankle's frame, the direction that points up and the direction from
/// heel to toe (unit, perpendicular) while the sole is flat on the ground.
struct Sole {
  Vec3 up = Vec3::UnitY();
  Vec3 forward = Vec3::UnitZ();
};

struct Soles {
  Sole right;
  Sole left;
};

/// Soles by the rest pose alone: flat while the shin stands upright on it; the direction of the
/// toes is that of the toe joint or end site, or without either at right angles to shin and hips.
/// Nothing where the rest pose says nothing of the kind (thighs that do not point away from the
/// spine, foot and shin in one line, as in files whose bones all lie along one axis): then estimate
/// them from a motion (kinematics/sole_estimate.h).
std::optional<Soles> SolesOfRestPose(const Skeleton& skeleton, const JointRoles& roles);

/// A pair of perpendicular directions near to these; nothing when they are almost parallel.
std::optional<Sole> MakeSole(const Vec3& up, const Vec3& towards_toes);

/// Where the toes are from the ankle, in the ankle's frame [m]: the toe joint, else the ankle's end
/// site, else nothing.
std::optional<Vec3> ToeOffset(const Skeleton& skeleton, const JointRoles& roles, JointRole ankle);

/// Length of arms and legs against the reference humanoid's (MotionAug sec. 1.6): what scales
/// radii.
double BodyScale(const Skeleton& skeleton, const JointRoles& roles);

/// Spheres at pelvis, spine, chest, head and hands, capsules along upper arms, forearms, thighs and
/// shins, boxes for the feet; all derived from bone vectors in the joints' own frames.
/// Source: MotionAug sec. 4.2 for radii, which scale with the body, and for the part of each bone
/// that its capsule covers. The foot differs: ours is symmetric and reaches from the heel to the
/// toe tip (theirs is tuned by hand and ends at the ball). Its sole lies below the toe joint by
/// half the box's thickness. Without a toe joint the foot is 0.33 of the shin long in front of the
/// ankle and the sole 0.18 of the shin below it. Errors: kFailedPrecondition MISSING_ROLES.
StatusOr<BodyShapes> MakeBodyShapes(const Skeleton& skeleton, const JointRoles& roles,
                                    const Soles& soles);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_BODY_SHAPES_H_
