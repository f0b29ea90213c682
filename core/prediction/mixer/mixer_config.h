#ifndef POISE_CORE_PREDICTION_MIXER_MIXER_CONFIG_H_
#define POISE_CORE_PREDICTION_MIXER_MIXER_CONFIG_H_

#include <vector>

#include "core/base/config_fields.h"

namespace poise::prediction {

/// Sizes of a mixer network.
struct MixerConfig {
  int past_frames = 10;    ///< [frames, 2 to 1000] looked at
  int future_frames = 25;  ///< [frames, 1 to 1000] predicted
  int width = 128;         ///< [1 to 4096] features of a joint
  int groups = 4;          ///< [1 to 256, divides width] of features that joints share in one way
  int hidden = 256;        ///< [1 to 16384] of the perceptrons within a joint
  int blocks = 6;          ///< [1 to 256]
  double dropout = 0.2;    ///< [0 to 0.9] while training

  std::vector<base::Field> Fields();
  /// Errors: kInvalidArgument CONFIG_VALUE_OUT_OF_RANGE.
  Status Validate() const;
};

/// Numbers that describe one frame of the past, for `joints` joints: per joint the rotation vector
/// from the last observed rotation to this frame's, in the joint's own frame; then the root's; then
/// where the root is, in the root's last frame [m].
constexpr int MixerFeatures(int joints) { return 3 * joints + 6; }
/// Numbers that describe the last observed pose: per joint two columns of its matrix (as
/// math::ToSixD); then the vertical in the root's frame.
constexpr int MixerStillFeatures(int joints) { return 6 * joints + 3; }

/// Inputs of a joint's token: DCT coefficients of its changes, frame by frame, and its two columns;
/// and of the root's: of its six numbers, and the vertical.
constexpr int MixerJointInputs(int past_frames) { return 3 * past_frames + 6; }
constexpr int MixerRootInputs(int past_frames) { return 6 * past_frames + 3; }

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_MIXER_MIXER_CONFIG_H_
