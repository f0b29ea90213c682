#ifndef POISE_CORE_CORRECTION_DEBIAS_DEBIAS_CONFIG_H_
#define POISE_CORE_CORRECTION_DEBIAS_DEBIAS_CONFIG_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/base/config_fields.h"
#include "core/base/status.h"
#include "core/learning/nn/trainer_config.h"

namespace poise::correction {

/// What the network sees beside the pose: where body and joints are a little before and after.
struct DebiasInput {
  int moments = 2;              ///< [>= 0] before, and as many after
  double spacing_s = 1 / 30.0;  ///< [s, > 0] between them; at least one frame

  std::vector<base::Field> Fields();
};

/// Where feet stay as they were imitated, by the height of the lower sole above the floor.
struct FootHold {
  bool enabled = true;
  double low_m = 0.03;   ///< [m, >= 0] up to here wholly
  double high_m = 0.12;  ///< [m, >= 0] from here on not at all
  bool root = true;      ///< the root, too, as far as one of them stays

  std::vector<base::Field> Fields();
};

/// How a character's habits are learned. Defaults are the preset `recommended`.
struct DebiasConfig {
  DebiasInput input;
  /// [>= 0] Hidden layers; 0: a linear map, which few clips can teach. It is found in closed form:
  /// optimizer and trainer are not used then.
  int layers = 0;
  int hidden = 256;    ///< [> 0] units of each hidden layer
  double dropout = 0;  ///< [0 to 1) of the inputs while it learns
  /// [>= 0] Of the weights' squares (per output) and of their sizes, against the mean square of
  /// what is not undone in units of its spread: ridge regression. What few actors have in common
  /// stays.
  double l2_weight = 0.1;
  double l1_weight = 0;
  /// Of a linear map: the root and each joint get the l2_weight of kL2Candidates, or no correction,
  /// that helps the actors of the training who are left out one at a time most. Needs two actors.
  bool choose_l2 = true;
  bool mirror = true;  ///< every pair teaches with left and right swapped, too
  /// [Hz, >= 0] Zero-phase low-pass of what the network changes, which is found frame by frame; 0:
  /// none.
  double cutoff_hz = 8;
  FootHold hold;
  /// The correction whose habits are learned: instant | fast, and the preset of CorrectionConfig.
  std::string effort = "instant";
  std::string correction = "recommended";

  learning::OptimizerConfig optimizer;
  learning::TrainerConfig trainer;

  DebiasConfig();
  /// `paper`: four layers of 512, the change to the neighbouring frames alone, L1 of 1e-4, batches
  /// of 4,096 frames, on the zero policy.
  /// Errors: kInvalidArgument UNKNOWN_PRESET.
  static StatusOr<DebiasConfig> FromPreset(std::string_view preset);

  std::vector<base::Field> Fields();
  Status Validate() const;
};

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_DEBIAS_DEBIAS_CONFIG_H_
