#ifndef POISE_CORE_PREDICTION_TRAINING_TRAINING_CLIPS_H_
#define POISE_CORE_PREDICTION_TRAINING_TRAINING_CLIPS_H_

#include <vector>

#include "core/motion/dataset/benchmark_clips.h"

namespace poise::prediction {

/// What a predictor learns from, and what its weights are chosen by: no frame is in both.
struct TrainingClips {
  /// (sequences) each with its variants: itself, mirrored, slower, faster. None is empty.
  std::vector<std::vector<motion::Clip>> train;
  std::vector<motion::Clip> validation;
};

struct SplitRules {
  int window = 0;                 ///< [frames, > 0]
  double validation_share = 0.1;  ///< of each sequence, at its end
  bool mirror = true;             ///< adds the mirror image of every variant
  bool speeds = true;             ///< adds slower and faster variants, which exist between frames
  bool drop_first_frame = false;  ///< which is a rest pose in the CMU text files
};

/// Splits the training sequences of a benchmark; its test sequences are not looked at. A sequence
/// that is shorter than four windows is for training alone: so short ones, of which there are few,
/// lose nothing.
/// Errors: kFailedPrecondition NO_WINDOWS (no sequence is as long as a window); those of Mirror.
StatusOr<TrainingClips> SplitForTraining(const motion::BenchmarkClips& clips,
                                         const SplitRules& rules);

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_TRAINING_TRAINING_CLIPS_H_
