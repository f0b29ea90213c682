#ifndef POISE_CORE_PUSH_LEARNED_POSE_CONFIG_H_
#define POISE_CORE_PUSH_LEARNED_POSE_CONFIG_H_

#include <vector>

#include "core/base/config_fields.h"

namespace poise::push {

/// The network that puts a body on a moving pendulum.
struct PoseConfig {
  int hidden = 96;          ///< [4 to 1024] units of the recurrent cell
  int lookahead = 12;       ///< [frames, 0 to 60] of the hip's path that it sees in advance
  bool lean_input = false;  ///< it sees the pendulum's lean, too

  std::vector<base::Field> Fields();
};

/// Hip path now and twice ahead: displacement and speed, of each (4), and the lean now (2).
inline constexpr int kPathSize = 14;
/// Joints of frame 0 from the pelvis (63) and the mass.
inline constexpr int kBodySize = 64;
/// Change since frame 0 of joints from the pelvis (63) and of the pelvis' height, then of the feet
/// (right, left) which of them swing (2) and the change since frame 0 of their footholds from the
/// pelvis (4). A foothold is where a toe stands, or will stand once it has come down.
inline constexpr int kPoseSize = 70;
inline constexpr int kHeightColumn = 63;
inline constexpr int kSwingColumn = 64;
inline constexpr int kFootholdColumn = 66;
inline constexpr double kPoseScale = 0.2;  ///< [m] of one unit of output

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_LEARNED_POSE_CONFIG_H_
