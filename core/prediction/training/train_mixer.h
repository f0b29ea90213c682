#ifndef POISE_CORE_PREDICTION_TRAINING_TRAIN_MIXER_H_
#define POISE_CORE_PREDICTION_TRAINING_TRAIN_MIXER_H_

#include <functional>
#include <string>

#include "core/base/run_context.h"
#include "core/base/tensor_file.h"
#include "core/motion/dataset/benchmark_clips.h"
#include "core/prediction/network_body.h"
#include "core/prediction/training/training_config.h"

namespace poise::prediction {

/// A trained network as numbers: MixerPredictor makes a predictor of it, without LibTorch.
struct TrainedMixer {
  NetworkBody body;
  base::TensorFile weights;
  int64_t steps = 0;
  int64_t best_step = -1;      ///< whose weights these are; -1: the last, for lack of held-out data
  double best_validation = 0;  ///< mean Euler error over windows and frames [rad]
  double seconds = 0;
  std::string curve_csv;  ///< the learning curve
};

/// Learns from the training sequences of a benchmark; the weights are those that were best on their
/// held-out ends. Same clips, config and seed, same weights.
/// Errors: config errors; those of SplitForTraining and Trainer::Run.
StatusOr<TrainedMixer> TrainMixer(const motion::BenchmarkClips& clips, MixerTraining config,
                                  const base::RunContext& context);

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_TRAINING_TRAIN_MIXER_H_
