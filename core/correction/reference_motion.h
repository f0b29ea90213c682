#ifndef POISE_CORE_CORRECTION_REFERENCE_MOTION_H_
#define POISE_CORE_CORRECTION_REFERENCE_MOTION_H_

#include <string>
#include <vector>

#include "core/base/config_fields.h"
#include "core/motion/clip.h"
#include "core/physics/humanoid_model.h"
#include "core/physics/state.h"

namespace poise::correction {

using math::Quat;
using math::Vec3;

/// How a clip becomes what the character imitates (MotionAug sec. 4.5).
struct ReferenceConfig {
  double velocity_cutoff_hz = 6;  ///< [Hz, > 0] zero-phase low-pass of velocities; the authors'
                                  ///< 1 Hz removes most of a kick's
  /// How the clip is put on the ground by the character's own foot boxes: lowest | median | none
  std::string floor = "lowest";
  /// [rad/s] A joint that turns faster between two frames and is back within flip_longest_s was
  /// flipped by the capture's solver; it is led past. The fastest kicks stay below 40.
  double flip_speed = 60;
  double flip_longest_s = 0.3;  ///< [s, >= 0] 0 leaves flips as they are

  std::vector<base::Field> Fields();
};

/// The motion to imitate: a clip on the character's 16 joints, with velocities and accelerations.
/// Constant after construction.
class ReferenceMotion {
 public:
  /// `clip` has the character's joints in role order (motion/editing/reduce.h).
  /// Errors: kInvalidArgument WRONG_SHAPE (not 16 joints), CONFIG_VALUE_OUT_OF_RANGE;
  /// kFailedPrecondition CLIP_TOO_SHORT (fewer than 4 frames).
  static StatusOr<ReferenceMotion> Create(const motion::Clip& clip,
                                          const physics::HumanoidModel& model,
                                          const ReferenceConfig& config = {});

  /// The clip as it stands on the floor.
  const motion::Clip& clip() const { return clip_; }
  int num_frames() const { return clip_.num_frames(); }
  double frame_rate() const { return clip_.frame_rate(); }
  const physics::State& frame(int index) const { return frames_[index]; }
  /// Between frames: positions lerped, rotations slerped; held at the last frame with no velocity.
  physics::State At(double time_s) const;
  physics::Speeds AccelerationAt(double time_s) const;

 private:
  explicit ReferenceMotion(motion::Clip clip) : clip_(std::move(clip)) {}

  motion::Clip clip_;
  std::vector<physics::State> frames_;          // (frames)
  std::vector<physics::Speeds> accelerations_;  // (frames)
};

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_REFERENCE_MOTION_H_
