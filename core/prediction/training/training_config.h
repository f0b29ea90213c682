#ifndef POISE_CORE_PREDICTION_TRAINING_TRAINING_CONFIG_H_
#define POISE_CORE_PREDICTION_TRAINING_TRAINING_CONFIG_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/base/config_fields.h"
#include "core/learning/nn/trainer_config.h"
#include "core/prediction/gcn/gcn_config.h"
#include "core/prediction/mixer/mixer_config.h"
#include "core/prediction/potr/potr_config.h"
#include "core/prediction/rnn/rnn_config.h"
#include "core/prediction/simlpe/simlpe_config.h"

namespace poise::prediction {

/// Everything that decides what a predictor becomes, but for data and seed. The defaults are the
/// preset `recommended`.
struct PredictorTraining {
  std::string family = "mixer";  ///< whose sizes below count
  int members = 2;               ///< [1 to 64] networks of which the mean is the answer
  MixerConfig mixer;
  GcnConfig gcn;
  RnnConfig rnn;
  PotrConfig potr;
  SimlpeConfig simlpe;
  learning::TrainerConfig trainer{.steps = 5000, .batch_size = 64, .validate_every = 500};
  learning::OptimizerConfig optimizer{.type = "adamw",
                                      .learning_rate = 1e-3,
                                      .weight_decay = 1e-2,
                                      .warmup_steps = 100,
                                      .schedule = "cosine",
                                      .clip_norm = 1};
  /// [0 to 0.5] of each long training sequence, at its end, that is held out to choose the weights;
  /// 0: those after the last step, learned from all.
  double validation_share = 0;
  /// [1 to 1000] Windows that reach over the end of a sequence count with the frames that there
  /// are, at least so many.
  int least_future_frames = 8;
  bool balanced = true;  ///< draw every sequence equally often, however long | every window
  bool mirror = true;    ///< learn from the mirror image of each sequence too
  bool speeds = true;    ///< and from each slower and faster by up to a fifth

  /// By PresetNames. For CMU at 60 Hz: "recommended"; as published "gcn" (LTD), "rnn" (Martinez et
  /// al.), "potr", "simlpe" (reference sec. 4). For HDM05 at 30 Hz, 12 frames in and 12 out:
  /// "recommended-hdm05"; as MotionAug has them "rnn-hdm05", "gcn-hdm05", and "potr-hdm05".
  /// Errors: kInvalidArgument UNKNOWN_PRESET.
  static StatusOr<PredictorTraining> FromPreset(std::string_view name);
  static std::vector<std::string> PresetNames();

  /// Of the chosen family.
  struct Frames {
    int past = 0, future = 0;
  };
  Frames frames() const;

  std::vector<base::Field> Fields();
  Status Validate();
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_TRAINING_TRAINING_CONFIG_H_
