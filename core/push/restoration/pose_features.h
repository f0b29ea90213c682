#ifndef POISE_CORE_PUSH_RESTORATION_POSE_FEATURES_H_
#define POISE_CORE_PUSH_RESTORATION_POSE_FEATURES_H_

#include <Eigen/Core>
#include <span>

#include "core/push/ground_frame.h"

/// A part of a body as the paper's pose models see it (reference sec. 6).
namespace poise::push {

/// Positions and rotations of one person, all kBodyJoints joints, frame by frame.
/// Units: positions [m] in the ground frame, rotations ground from joint
struct BodyMotion {
  int frames = 0;
  std::span<const Vec3> positions;        // (frames, joints)
  std::span<const math::Quat> rotations;  // (frames, joints)
};

/// Shape: (frames - 1, 3 + 12 joints): displacement of the pelvis from frame 0 [mm] (2), turn of
/// the facing since frame 0 [rad] (1), positions [mm] (3 a joint), velocities to the next frame
/// [mm/frame] (3 a joint), first two columns of the rotation, row by row (6 a joint).
/// `joints` is kLowerBody or kUpperBody. Positions are those of the frame, not moved.
/// Preconditions: at least two frames; the body faces +X to within 90 degrees.
Eigen::MatrixXd PoseFeatures(const BodyMotion& motion, std::span<const int> joints);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_RESTORATION_POSE_FEATURES_H_
