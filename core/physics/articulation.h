#ifndef POISE_CORE_PHYSICS_ARTICULATION_H_
#define POISE_CORE_PHYSICS_ARTICULATION_H_

/// Bodies joined in a tree by ball joints, as plain numbers: what the kernels, which are built once
/// per instruction set, share with the rest. Body 0 is the root; parents come first.
///
/// Speeds u (3 + 3 * bodies numbers): u[0..2] the root's linear velocity and u[3..5] its angular
/// velocity, both in world axes; u[3 + 3 i ..] of body i >= 1 the angular velocity against its
/// parent, in its own axes. Forces have the same layout. The numbers of a rigid joint are 0.
/// A rotation is four numbers x y z w (Eigen's memory order).
namespace poise::physics {

inline constexpr int kMaxBodies = 16;
inline constexpr int kMaxSpeeds = 3 + 3 * kMaxBodies;
inline constexpr int kMaxContacts = 40;

enum class Geometry : int { kNone, kSphere, kCapsule, kBox };

/// One rigid body, in the frame of the joint that carries it (the body's frame).
struct Body {
  int parent = -1;
  bool rigid_joint = false;  ///< moves with its parent; its rotation stays what it is
  double offset[3] = {};     ///< [m] of the joint, in the parent's frame
  double mass = 0;           ///< [kg]
  double center_of_mass[3] = {};
  double inertia[9] = {};   ///< [kg m2] about the centre of mass, column by column
  double stiffness = 0;     ///< [N m/rad] of the joint's controller
  double damping = 0;       ///< [N m s/rad]
  double torque_limit = 0;  ///< [N m] longest torque; 0 = none

  Geometry geometry = Geometry::kNone;
  double shape_center[3] = {};
  double shape_axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< columns: the shape's x, y, z
  double radius = 0;            ///< [m] sphere, capsule (along the shape's y)
  double half_length = 0;       ///< [m] capsule, without caps
  double half_extents[3] = {};  ///< [m] box
};

struct Articulation {
  int num_bodies = 0;
  bool fixed_base = false;  ///< the root is bolted to the world
  Body bodies[kMaxBodies];

  int num_speeds() const { return 3 + 3 * num_bodies; }
};

}  // namespace poise::physics

#endif  // POISE_CORE_PHYSICS_ARTICULATION_H_
