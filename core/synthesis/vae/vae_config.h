#ifndef POISE_CORE_SYNTHESIS_VAE_VAE_CONFIG_H_
#define POISE_CORE_SYNTHESIS_VAE_VAE_CONFIG_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/base/config_fields.h"
#include "core/base/status.h"
#include "core/learning/nn/trainer_config.h"

namespace poise::synthesis {

/// Sizes of the networks; part of what a model is.
struct VaeNetConfig {
  /// lstm: LSTMs that pass from frame to frame, as in the paper | frames: layers that see one
  /// frame, its change to the next and the clock, so that all frames are one matrix product.
  std::string layers = "frames";
  int latent = 128;        ///< [> 0] dimensions of z (MotionAug sec. 4.1)
  int hidden = 128;        ///< [> 0] units of a layer, or of an LSTM per direction (paper: 256)
  int embedding = 128;     ///< [> 0] of a pose before an LSTM or a frame's verdict
  int length_hidden = 32;  ///< [> 0] of the length estimator
  /// [>= 0] Frequencies of the clock: sine and cosine of 1, 2, 4, ... half turns over the frames.
  /// Of the LSTMs only the decoder's sees it, beside z; 0: none, as in the paper, where it has to
  /// count. Layers of single frames need one.
  int clock = 6;

  std::vector<base::Field> Fields();
};

/// How the VAE learns. Defaults are the preset `recommended`.
struct VaeConfig {
  VaeNetConfig net;

  /// vae | gan: the baseline of MotionAug sec. 4.1, the decoder alone, fed with noise, against the
  /// two discriminators. Of the weights below only those of the adversaries count then.
  std::string generator = "vae";
  double frame_rate = 30;  ///< [Hz] of the motions it learns
  /// Unit of the root position in input and loss: standardised (mean 0, deviation 1 of each axis
  /// over the training frames) | metres | authors (5 cm, in which it dominates the loss).
  std::string root_unit = "standardised";

  /// Training begins at the mean pose and length of the training motions.
  bool start_at_mean = true;

  double smoothness_weight = 0.001;         ///< [>= 0] second differences (reference sec. 2.4)
  double kl_weight = 0.01;                  ///< [>= 0]
  double length_weight = 0.01;              ///< [>= 0]
  bool adversarial = true;                  ///< with frame and sequence discriminators
  double frame_adversary_weight = 0.03;     ///< [>= 0] paper: 1
  double sequence_adversary_weight = 0.03;  ///< [>= 0] paper: 1

  learning::OptimizerConfig vae_optimizer;
  learning::OptimizerConfig discriminator_optimizer;
  learning::TrainerConfig trainer;

  VaeConfig();
  /// `paper`: SGD at 0.005, halved every 4,000 of 20,000 steps, batches of 128, 5 cm units.
  /// Errors: kInvalidArgument UNKNOWN_PRESET.
  static StatusOr<VaeConfig> FromPreset(std::string_view preset);

  std::vector<base::Field> Fields();
  Status Validate() const;
};

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_VAE_VAE_CONFIG_H_
