#include "tests/core/correction/tracked_clip.h"

#include <cmath>

#include "core/motion/editing/reduce.h"
#include "core/motion/io/clip_file.h"
#include "tests/support/test_clips.h"

namespace poise::correction {

TrackedClip Prepare(const motion::Clip& clip, const ReferenceConfig& config) {
  const motion::JointRoles roles = *motion::JointRoles::Detect(*clip.skeleton());
  const motion::Clip reduced =
      *motion::ReduceToRoles(clip, roles, motion::ReductionMode::kComposed);
  const motion::JointRoles reduced_roles = *motion::JointRoles::Detect(*reduced.skeleton());
  const physics::HumanoidModelPtr model = *physics::HumanoidModel::Create(reduced, reduced_roles);
  return {model, *ReferenceMotion::Create(reduced, *model, config)};
}

TrackedClip ReadAndPrepare(const std::filesystem::path& file, const ReferenceConfig& config) {
  return Prepare(motion::ReadClipFile(file)->clip, config);
}

motion::Clip SwayingClip(double seconds) {
  constexpr double kFrameRate = 120;
  const motion::SkeletonPtr skeleton = testing::Biped();
  const auto frames = static_cast<int>(seconds * kFrameRate) + 1;
  std::vector<Vec3> positions(frames, Vec3(0, 0.95, 0));
  std::vector<Quat> rotations(static_cast<size_t>(frames) * skeleton->num_joints(),
                              Quat::Identity());
  const motion::JointRoles roles = *motion::JointRoles::Detect(*skeleton);
  for (int frame = 0; frame < frames; ++frame) {
    const double t = std::max(frame / kFrameRate - 1, 0.0);
    const double angle = 0.6 * (1 - std::cos(3 * t));
    Quat* pose = rotations.data() + static_cast<size_t>(frame) * skeleton->num_joints();
    pose[roles.joint(motion::JointRole::kLeftShoulder)] =
        math::FromRotationVector(Vec3(0, 0, -angle));
    pose[roles.joint(motion::JointRole::kRightShoulder)] =
        math::FromRotationVector(Vec3(0, 0, angle));
  }
  return *motion::Clip::Create("swaying", skeleton, kFrameRate, positions, rotations);
}

}  // namespace poise::correction
