#include "core/push/restoration/pose_features.h"

#include <cmath>

#include "core/push/body_joints.h"

namespace poise::push {
namespace {

constexpr double kMillimetres = 1000;  // the authors' unit

double Facing(std::span<const Vec3> pose) {
  const Vec3 facing = (pose[kRightHip] - pose[kPelvis]).cross(pose[kLeftHip] - pose[kPelvis]);
  return std::atan(facing.y() / facing.x());
}

}  // namespace

Eigen::MatrixXd PoseFeatures(const BodyMotion& motion, std::span<const int> joints) {
  const int count = static_cast<int>(joints.size());
  const auto pose = [&](int frame) { return motion.positions.subspan(frame * kBodyJoints); };
  Eigen::MatrixXd features(motion.frames - 1, 3 + 12 * count);
  for (int frame = 0; frame + 1 < motion.frames; ++frame) {
    const auto now = pose(frame), next = pose(frame + 1);
    features.block<1, 2>(frame, 0) =
        kMillimetres * (now[kPelvis] - pose(0)[kPelvis]).head<2>().transpose();
    features(frame, 2) = Facing(now) - Facing(pose(0));
    for (int i = 0; i < count; ++i) {
      const int joint = joints[i];
      features.block<1, 3>(frame, 3 + 3 * i) = kMillimetres * now[joint].transpose();
      features.block<1, 3>(frame, 3 + 3 * count + 3 * i) =
          kMillimetres * (next[joint] - now[joint]).transpose();
      const math::Mat3 turn = motion.rotations[frame * kBodyJoints + joint].toRotationMatrix();
      for (int axis = 0; axis < 3; ++axis) {
        features.block<1, 2>(frame, 3 + 6 * count + 6 * i + 2 * axis) = turn.block<1, 2>(axis, 0);
      }
    }
  }
  return features;
}

}  // namespace poise::push
