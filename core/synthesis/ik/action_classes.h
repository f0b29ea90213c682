#ifndef POISE_CORE_SYNTHESIS_IK_ACTION_CLASSES_H_
#define POISE_CORE_SYNTHESIS_IK_ACTION_CLASSES_H_

#include <span>
#include <string_view>

#include "core/base/status.h"

namespace poise::synthesis {

enum class LimbKind { kLeg, kArm };

/// What IK synthesis edits in one class of actions, and how far.
/// Source: MotionAug sec. 4.3 and supplement D, completed by the authors' program (reference
/// sec. 1.9, 3.2, 3.3).
struct ActionClass {
  const char* name;
  LimbKind limb;  ///< which end effector: ankle or wrist
  /// Both sides act (a stride): the keyframe is where they are farthest apart, and the leading one
  /// is edited. Otherwise one side acts, and the keyframe is where it is farthest from the pelvis.
  bool two_sided;
  double radius_low, radius_high;  ///< factor on the horizontal distance from the limb's base
  double height_low, height_high;  ///< factor on the height above the ground
  double angle;                    ///< [rad] +- about the vertical axis through the limb's base
};

/// All of them: kick, punch, walk, jog, sneak, grab, deposit, throw.
std::span<const ActionClass> ActionClasses();

/// Errors: kInvalidArgument UNKNOWN_ACTION_CLASS, naming the known ones.
StatusOr<ActionClass> FindActionClass(std::string_view name);

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_IK_ACTION_CLASSES_H_
