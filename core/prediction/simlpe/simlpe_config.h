#ifndef POISE_CORE_PREDICTION_SIMLPE_SIMLPE_CONFIG_H_
#define POISE_CORE_PREDICTION_SIMLPE_SIMLPE_CONFIG_H_

#include <vector>

#include "core/base/config_fields.h"

namespace poise::prediction {

/// Sizes of siMLPe; the defaults are the paper's, on the columns of CMU.
/// Source: reference sec. 4.4.
struct SimlpeConfig {
  int past_frames = 50;    ///< [frames, 2 to 1000] looked at
  int future_frames = 25;  ///< [frames, 1 to past_frames] predicted
  int blocks = 48;         ///< [1 to 256] of a linear layer along time each
  bool root = false;       ///< the root's columns too

  std::vector<base::Field> Fields();
  /// Errors: kInvalidArgument CONFIG_VALUE_OUT_OF_RANGE.
  Status Validate() const;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_SIMLPE_SIMLPE_CONFIG_H_
