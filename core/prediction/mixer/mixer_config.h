#ifndef POISE_CORE_PREDICTION_MIXER_MIXER_CONFIG_H_
#define POISE_CORE_PREDICTION_MIXER_MIXER_CONFIG_H_

#include <vector>

#include "core/base/config_fields.h"

namespace poise::prediction {

/// Sizes of a mixer network.
struct MixerConfig {
  int past_frames = 50;    ///< [frames, 2 to 1000] looked at
  int future_frames = 25;  ///< [frames, 1 to 1000] predicted
  int width = 128;         ///< [1 to 4096] features of a pose
  int hidden = 256;        ///< [1 to 16384] of the perceptrons that mix the pose
  int blocks = 4;          ///< [1 to 256]
  double dropout = 0.15;   ///< [0 to 0.9] while training

  std::vector<base::Field> Fields();
};

/// Numbers that describe one frame of the past, for `joints` joints: per joint the rotation vector
/// from the last observed rotation to this frame's, in the joint's own frame; then the root's; then
/// where the root is, in the root's last frame [m].
constexpr int MixerFeatures(int joints) { return 3 * joints + 6; }
/// Numbers that describe the last observed pose: per joint two columns of its matrix (as
/// math::ToSixD); then the vertical in the root's frame.
constexpr int MixerStillFeatures(int joints) { return 6 * joints + 3; }

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_MIXER_MIXER_CONFIG_H_
