#ifndef POISE_CORE_PREDICTION_POTR_POTR_CONFIG_H_
#define POISE_CORE_PREDICTION_POTR_POTR_CONFIG_H_

#include <vector>

#include "core/base/config_fields.h"

namespace poise::prediction {

/// Sizes of POTR; the defaults are the paper's, on the columns of CMU. Source: reference sec. 4.3.
struct PotrConfig {
  int past_frames = 50;    ///< [frames, 3 to 1000] looked at: the source, and the frame asked with
  int future_frames = 25;  ///< [frames, 1 to 1000] predicted
  bool root = false;       ///< the root's path and rotation are two more nodes (MotionAug)
  int node_width = 512;    ///< [1 to 4096] features of a joint
  int joint_width = 128;   ///< [1 to 4096] what is left of them when a frame is one vector
  int width = 128;         ///< [2 to 4096, even] features of a frame
  int heads = 4;           ///< [1 to 64, divides width]
  int layers = 4;          ///< [1 to 64] of the encoder, and as many of the decoder
  int hidden = 2048;       ///< [1 to 16384] of their perceptrons
  double dropout = 0.3;    ///< [0 to 0.9] while training
  /// Around the decoder's perceptrons; the authors' program has none there.
  bool residual = true;

  std::vector<base::Field> Fields();
  /// Errors: kInvalidArgument CONFIG_VALUE_OUT_OF_RANGE.
  Status Validate() const;
};

/// Fixed encoding of frames 0, 1, ...: (frames, width), row by row. Sine on even features, cosine
/// on odd ones, of 10 frame / 500^(2 floor(feature / 2) / width).
std::vector<float> PotrPositions(int frames, int width);

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_POTR_POTR_CONFIG_H_
