#ifndef POISE_SAMPLES_AUTHOR_PERFORMANCE_H_
#define POISE_SAMPLES_AUTHOR_PERFORMANCE_H_

#include <array>
#include <string>

#include "core/motion/clip.h"
#include "samples/author/body.h"
#include "samples/author/track.h"

namespace poise::samples {

/// A limb led by its joint angles instead of by a goal. All in degrees, in world axes:
/// x  elevation of the upper bone from hanging down (0) to straight ahead (90)
/// y  the same bone's swing outward
/// z  flexion of the knee or elbow
/// `weight` runs from 0 (the goal leads) to 1 (the angles lead).
struct FreeLimb {
  Channel weight = [](double) { return 0.0; };
  VectorChannel angles = [](double) { return math::Vec3::Zero().eval(); };
  /// [deg] turn of the hinge about the upper bone: moves knee or elbow outward.
  Channel roll = [](double) { return 0.0; };
};

/// A leg: its foot's place on the floor, or free angles.
struct LegScript {
  /// [m] where the ball of the foot is while the sole is level; y = 0 on the floor.
  VectorChannel ball;
  /// [deg] x toe-out, y heel strike (the foot turned about the back of the heel, toes up), z
  /// heel rise (the foot turned over ball and toe tip, heel up; the toes bend back).
  VectorChannel foot;
  /// [deg] how far the knee points outward of the toes.
  Channel knee_out = [](double) { return 0.0; };
  FreeLimb free;
  /// [deg] of a free leg's foot; 0 is square to the shank, positive lifts the toes.
  Channel free_dorsiflexion = [](double) { return 0.0; };
};

/// An arm: the wrist's place, or free angles.
struct ArmScript {
  /// [m] x outward, y up, z ahead of the middle between the shoulders, in world axes.
  VectorChannel wrist = [](double) { return math::Vec3(0.2, -0.5, 0.0); };
  /// Direction in which the elbow points, axes as `wrist`.
  VectorChannel elbow = [](double) { return math::Vec3(0.4, -1.0, -0.4); };
  FreeLimb free;
  /// [deg] x shoulder forward, y shoulder up.
  VectorChannel collar = [](double) { return math::Vec3::Zero().eval(); };
  /// [deg] x turn of the hand about the forearm (thumb up positive), y flexion of the wrist.
  VectorChannel hand = [](double) { return math::Vec3::Zero().eval(); };
};

/// Everything that is said about one performance; the rest follows from the body.
/// Turns are x yaw to the left, y pitch forward, z lean to the left, in degrees, world axes,
/// applied in that order.
struct Performance {
  std::string name;
  double seconds = 0;
  double frame_rate = 120;
  VectorChannel pelvis;  ///< [m] position
  VectorChannel pelvis_turn;
  VectorChannel chest_turn;
  VectorChannel head_turn;
  std::array<LegScript, 2> legs;  ///< by Side
  std::array<ArmScript, 2> arms;  ///< by Side

  LegScript& leg(Side side) { return legs[static_cast<int>(side)]; }
  ArmScript& arm(Side side) { return arms[static_cast<int>(side)]; }
};

/// Solves every frame: trunk by its turns, limbs by inverse kinematics or by their free angles.
StatusOr<motion::Clip> Perform(const Performance& performance);

}  // namespace poise::samples

#endif  // POISE_SAMPLES_AUTHOR_PERFORMANCE_H_
