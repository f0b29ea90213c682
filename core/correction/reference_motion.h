#ifndef POISE_CORE_CORRECTION_REFERENCE_MOTION_H_
#define POISE_CORE_CORRECTION_REFERENCE_MOTION_H_

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/config_fields.h"
#include "core/correction/preparation/preparation_config.h"
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
  /// How the clip is put on the ground by the character's own foot boxes: still (where feet that
  /// stand show it: metrics/floor_contact.h) | lowest | median | none (the floor is y = 0)
  std::string floor = "still";
  /// [rad/s] A joint that turns faster between two frames and is back within flip_longest_s was
  /// flipped by the capture's solver; it is led past. The fastest kicks stay below 40.
  double flip_speed = 60;
  double flip_longest_s = 0.3;  ///< [s, >= 0] 0 leaves flips as they are
  PreparationConfig preparation;
  double unload_s = 0.05;  ///< [s, >= 0] in which a foot hands over its load before it is lifted

  /// `paper`: as the authors' program and the correction spike: the lowest frame stands on the
  /// floor, nothing is prepared. Errors: kInvalidArgument UNKNOWN_PRESET.
  static StatusOr<ReferenceConfig> FromPreset(std::string_view preset);

  std::vector<base::Field> Fields();
};

/// The motion to imitate: a clip on the character's 16 joints, with velocities and accelerations.
/// It is kept twice: as it came, on the floor, which rewards and measures compare with; and as it
/// was prepared (preparation/preparation.h), which the character aims at. So no reward can be
/// gained by a preparation that strays. Constant after construction.
class ReferenceMotion {
 public:
  /// `clip` has the character's joints in role order (motion/editing/reduce.h).
  /// Errors: kInvalidArgument WRONG_SHAPE (not 16 joints), CONFIG_VALUE_OUT_OF_RANGE;
  /// kFailedPrecondition CLIP_TOO_SHORT (fewer than 4 frames).
  static StatusOr<ReferenceMotion> Create(const motion::Clip& clip,
                                          const physics::HumanoidModel& model,
                                          const ReferenceConfig& config = {});

  /// The clip as it came, on the floor; its frames are led past flips.
  const motion::Clip& source_clip() const { return source_clip_; }
  const physics::State& source_frame(int index) const { return source_frames_[index]; }
  Vec3 SourceRootAt(double time_s) const;  ///< [m] between frames lerped, held at the end

  /// The clip as it is to be imitated; frame, At and AccelerationAt are of this one.
  const motion::Clip& clip() const { return clip_; }
  int num_frames() const { return clip_.num_frames(); }
  double frame_rate() const { return clip_.frame_rate(); }
  const physics::State& frame(int index) const { return frames_[index]; }
  /// Between frames: positions lerped, rotations slerped; held at the last frame with no velocity.
  physics::State At(double time_s) const;
  physics::Speeds AccelerationAt(double time_s) const;
  /// How much of the body's weight the right and the left foot can take, 0 to 1: 1 while the foot
  /// stands, fading before it is lifted.
  std::array<double, 2> FootLoads(double time_s) const;

 private:
  ReferenceMotion(motion::Clip source, motion::Clip prepared)
      : source_clip_(std::move(source)), clip_(std::move(prepared)) {}

  motion::Clip source_clip_;
  motion::Clip clip_;
  std::vector<physics::State> source_frames_;      // (frames)
  std::vector<physics::State> frames_;             // (frames)
  std::vector<physics::Speeds> accelerations_;     // (frames)
  std::vector<std::array<double, 2>> foot_loads_;  // (frames)
};

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_REFERENCE_MOTION_H_
