#ifndef POISE_CORE_CORRECTION_DEBIAS_DEBIAS_NET_H_
#define POISE_CORE_CORRECTION_DEBIAS_DEBIAS_NET_H_

#include <torch/torch.h>

#include "core/correction/debias/debias_config.h"

namespace poise::correction {

/// Frame rows, standardised, to corrections in units of their spread: layers with LeakyReLU between
/// them and dropout before the first. The last begins at zero: what is not learned is not changed.
/// What Debiaser computes.
class DebiasNet : public torch::nn::Module {
 public:
  explicit DebiasNet(const DebiasConfig& config);
  /// (rows, InputWidth) -> (rows, kCorrectionWidth)
  torch::Tensor forward(const torch::Tensor& rows);
  /// What the config's penalties come to, biases apart.
  torch::Tensor Penalty(const DebiasConfig& config) const;

 private:
  torch::nn::Dropout dropout_;
  std::vector<torch::nn::Linear> layers_;  // layer0, layer1, ...
};

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_DEBIAS_DEBIAS_NET_H_
