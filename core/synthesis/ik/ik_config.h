#ifndef POISE_CORE_SYNTHESIS_IK_IK_CONFIG_H_
#define POISE_CORE_SYNTHESIS_IK_IK_CONFIG_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/base/config_fields.h"
#include "core/base/status.h"
#include "core/synthesis/ik/action_classes.h"

namespace poise::synthesis {

/// How IK synthesis moves one limb (MotionAug sec. 3.2, 4.3; section numbers below are those of the
/// reference). Defaults are the preset `recommended`; FromPreset says what `paper` changes and why.
struct IkConfig {
  // Target region: a fan in cylinder coordinates about the limb's base (sec. 3.3). From the action
  // class; these defaults are the kick's.
  double radius_low = 0.8;   ///< [0, 10] factor on the horizontal distance
  double radius_high = 1.2;  ///< [radius_low, 10]
  double height_low = 0.8;   ///< [0, 10] factor on the height above the floor
  double height_high = 1.2;  ///< [height_low, 10]
  double angle = 0.785;      ///< [rad, 0 to pi] +- about the vertical
  double floor_m = 0;        ///< [m] height of the floor in the world

  // Keyframe (sec. 3.2).
  std::string keyframe_rule = "reference";  ///< reference | paper
  int keyframe = -1;                        ///< frame chosen by hand; -1 = by the rule
  std::string end_effector = "auto";        ///< auto, or left_ankle, right_wrist, ...

  // Propagation of the displacement over time (sec. 3.4).
  std::string propagation =
      "window";           ///< window: within window_s of the keyframe | ramp: whole clip
  double window_s = 0.4;  ///< [s, > 0] half width of the window
  std::string profile = "minimum_jerk";  ///< minimum_jerk (no kink) | linear

  /// What is spread. position: the end's displacement, clamped to the reachable shell in each frame
  /// | limb: the swing of the limb about its base and its flexion. Both put the end on the target
  /// at the keyframe.
  std::string spread = "limb";

  // The limb (sec. 3.5).
  /// exact: where FABRIK's iteration ends, in closed form | iterative: the iteration itself, of
  /// which 50 passes leave a nearly straight limb some millimetres short
  std::string solver = "exact";
  double tolerance = 1e-4;           ///< [m, > 0] distance that stops the iteration
  int max_iterations = 50;           ///< of the iteration
  std::string bend_plane = "swung";  ///< swung with the limb | kept: through the old joint
  bool hinge_limit = false;          ///< refuse flexion beyond max_flexion
  double max_flexion = 2.7925268;    ///< [rad] 160 degrees

  /// The class's region and the preset's rules. `recommended` differs from `paper` in
  ///  - keyframe_rule: the authors' program picks a stride's peak, the paper's text the frame where
  ///    one foot is farthest from the body, which a standing leg can win;
  ///  - propagation: a window leaves the approach and the landing as they were, the paper's ramp
  ///    drags the foot along the floor during the whole clip;
  ///  - profile: the linear ramp has kinks at the keyframe and at its ends, each a jump of velocity
  ///    within one frame;
  ///  - spread: a position is clamped wherever the limb comes near its full length, which stops the
  ///    knee within one frame (kicks: 3.5 times the acceleration that the edit implies, against
  ///    0.8);
  ///  - bend_plane: a plane through the old knee flips when the target passes over the thigh (12
  ///    times), and shows the jitter of a nearly straight limb enlarged when the limb bends farther
  ///    (1.5 times), so that the plane is averaged over 0.1 s too.
  /// Errors: kInvalidArgument UNKNOWN_ACTION_CLASS, UNKNOWN_PRESET.
  static StatusOr<IkConfig> FromPreset(std::string_view preset, const ActionClass& action_class);

  std::vector<base::Field> Fields();
  /// Errors: kInvalidArgument CONFIG_VALUE_OUT_OF_RANGE where a low is above its high.
  Status Validate() const;
};

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_IK_IK_CONFIG_H_
