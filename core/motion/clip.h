#ifndef POISE_CORE_MOTION_CLIP_H_
#define POISE_CORE_MOTION_CLIP_H_

#include <span>
#include <string>
#include <vector>

#include "core/base/status.h"
#include "core/motion/skeleton.h"

namespace poise::motion {

/// A motion of one body: a skeleton, a frame rate, and per frame the root's position and every
/// joint's rotation.
/// Shapes:  root_positions (frames, 3); rotations (frames, joints), frame by frame
/// Units:   metres, seconds; world frame right-handed with Y up. A rotation is a unit quaternion
///          local to the parent joint; the root's is from root to world.
/// The root joint's world position is the root position; its own offset does not add to it.
/// Invariants: at least one frame, all numbers finite, all quaternions unit length.
class Clip {
 public:
  static constexpr int64_t kMaxFrames = 10'000'000;
  static constexpr double kMaxFrameRate = 10'000;  ///< [Hz]

  /// Normalises the quaternions. Errors: kInvalidArgument: NO_FRAMES, BAD_FRAME_RATE (outside
  /// (0, kMaxFrameRate]), WRONG_SHAPE (rotations are not frames x joints), NOT_FINITE and
  /// NOT_A_ROTATION (length off by more than 1e-2; frame and joint in the message).
  static StatusOr<Clip> Create(std::string name, SkeletonPtr skeleton, double frame_rate,
                               std::vector<Vec3> root_positions, std::vector<Quat> rotations);

  const std::string& name() const { return name_; }
  void set_name(std::string name) { name_ = std::move(name); }
  const SkeletonPtr& skeleton() const { return skeleton_; }
  double frame_rate() const { return frame_rate_; }
  int num_frames() const { return static_cast<int>(root_positions_.size()); }
  int num_joints() const { return skeleton_->num_joints(); }
  /// Time from the first frame to the last [s].
  double duration() const { return (num_frames() - 1) / frame_rate_; }

  const Vec3& root_position(int frame) const { return root_positions_[frame]; }
  Vec3& root_position(int frame) { return root_positions_[frame]; }
  const Quat& rotation(int frame, int joint) const { return rotations_[Index(frame, joint)]; }
  Quat& rotation(int frame, int joint) { return rotations_[Index(frame, joint)]; }
  /// The joints' rotations of one frame.
  std::span<const Quat> pose(int frame) const {
    return {rotations_.data() + Index(frame, 0), static_cast<size_t>(num_joints())};
  }
  std::span<const Vec3> root_positions() const { return root_positions_; }
  std::span<const Quat> rotations() const { return rotations_; }

 private:
  Clip(std::string name, SkeletonPtr skeleton, double frame_rate, std::vector<Vec3> root_positions,
       std::vector<Quat> rotations)
      : name_(std::move(name)),
        skeleton_(std::move(skeleton)),
        frame_rate_(frame_rate),
        root_positions_(std::move(root_positions)),
        rotations_(std::move(rotations)) {}

  size_t Index(int frame, int joint) const {
    return static_cast<size_t>(frame) * num_joints() + joint;
  }

  std::string name_;
  SkeletonPtr skeleton_;
  double frame_rate_;
  std::vector<Vec3> root_positions_;  // (frames)
  std::vector<Quat> rotations_;       // (frames, joints)
};

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_CLIP_H_
