#ifndef POISE_CORE_PUSH_LEARNED_HIP_CONFIG_H_
#define POISE_CORE_PUSH_LEARNED_HIP_CONFIG_H_

#include <vector>

#include "core/base/config_fields.h"

namespace poise::push {

/// The network that moves pendulums: per person a recurrent cell that sees its pendulum, what its
/// neighbours do (messages) and, for who is pushed, the push.
struct HipConfig {
  int hidden = 48;          ///< [4 to 1024] units of the recurrent cell
  int message = 16;         ///< [1 to 256] numbers that a neighbour's message has
  int message_hidden = 32;  ///< [1 to 1024] units of the network that makes it
  double reach_m = 1.6;     ///< [m, 0.2 to 10] distance of hips at which messages have faded out
  bool messages = true;     ///< false: an ablation without interaction

  std::vector<base::Field> Fields();
};

/// What a person is told once: is pushed, impulse / mass, push frames, long push, alone, mass, lean
/// in frame 0 (2).
inline constexpr int kContextSize = 8;
/// Relative place and speed, distance, own lean and speed, the other's.
inline constexpr int kPairSize = 13;
/// Hip speed and displacement, lean and its rate since frame 0, push; then message and context.
inline constexpr int kOwnSize = 10;
/// Accelerations of hip (2) and lean (2).
inline constexpr int kDriveSize = 4;

/// Scales that bring inputs and outputs near 1.
inline constexpr double kPushScale = 0.1;        ///< of force / mass
inline constexpr double kLeanScale = 5;          ///< of angles [rad]
inline constexpr double kHipAcceleration = 10;   ///< [m/s^2] of one unit of output
inline constexpr double kLeanAcceleration = 20;  ///< [rad/s^2]

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_LEARNED_HIP_CONFIG_H_
