#ifndef POISE_CORE_PREDICTION_GCN_GCN_CONFIG_H_
#define POISE_CORE_PREDICTION_GCN_GCN_CONFIG_H_

#include <vector>

#include "core/base/config_fields.h"

namespace poise::prediction {

/// Sizes of LTD's graph network; the defaults are the paper's for CMU. Source: reference sec. 4.2.
struct GcnConfig {
  int past_frames = 10;    ///< [frames, 2 to 1000] looked at
  int future_frames = 25;  ///< [frames, 1 to 1000] predicted
  int coefficients = 0;    ///< [0 to 2000] of the DCT over past and future; 0: all
  bool root = false;       ///< the root's columns are nodes too (MotionAug)
  bool moving = true;      ///< nodes are the columns that move | all of joints that move
  int width = 256;         ///< [1 to 4096] features of a node
  int blocks = 12;         ///< [1 to 256] of two graph convolutions each
  double dropout = 0.5;    ///< [0 to 0.9] while training

  int frames() const { return past_frames + future_frames; }
  int kept_coefficients() const { return coefficients > 0 ? coefficients : frames(); }
  int layers() const { return 2 * blocks + 2; }
  std::vector<base::Field> Fields();
  /// Errors: kInvalidArgument CONFIG_VALUE_OUT_OF_RANGE.
  Status Validate() const;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_GCN_GCN_CONFIG_H_
