#ifndef POISE_CORE_PREDICTION_RNN_RNN_CONFIG_H_
#define POISE_CORE_PREDICTION_RNN_RNN_CONFIG_H_

#include <vector>

#include "core/base/config_fields.h"

namespace poise::prediction {

/// Sizes of the residual recurrent network; the defaults are Martinez et al.'s on CMU.
/// Source: reference sec. 4.1.
struct RnnConfig {
  int past_frames = 50;    ///< [frames, 2 to 1000] looked at
  int future_frames = 25;  ///< [frames, 1 to 1000] predicted
  int hidden = 1024;       ///< [1 to 16384] state of the cell; MotionAug 64
  bool root = false;       ///< the root's columns too (MotionAug)
  bool normalised = true;  ///< columns by their mean and deviation (MotionAug: as they are)
  bool squared = true;     ///< loss: mean squared error | sum of absolute errors (MotionAug)

  std::vector<base::Field> Fields();
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_RNN_RNN_CONFIG_H_
