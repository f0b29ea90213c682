#ifndef POISE_CORE_MOTION_JOINT_MASK_H_
#define POISE_CORE_MOTION_JOINT_MASK_H_

#include <vector>

namespace poise::motion {

/// Which joints were seen in which frames of a clip. Empty: all of them.
/// Shapes: visible (frames, joints), frame by frame
struct JointMask {
  std::vector<bool> visible = {};

  bool empty() const { return visible.empty(); }
};

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_JOINT_MASK_H_
