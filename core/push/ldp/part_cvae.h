#ifndef POISE_CORE_PUSH_LDP_PART_CVAE_H_
#define POISE_CORE_PUSH_LDP_PART_CVAE_H_

#include <torch/torch.h>

#include "core/push/ldp/ldp_config.h"

namespace poise::push::ldp {

/// A normal distribution for each number of a latent.
struct LatentTensors {
  torch::Tensor mean, log_variance;  ///< (rows, latent)

  torch::Tensor Draw() const { return mean + (log_variance / 2).exp() * torch::randn_like(mean); }
};

/// Input and condition to a latent: two layers that see the input again each time.
class LatentEncoderImpl : public torch::nn::Module {
 public:
  /// `bounded`: mean and log variance stay in the sampler's ranges.
  LatentEncoderImpl(int64_t input, int64_t condition, const BodyConfig& config, bool bounded);
  LatentTensors forward(const torch::Tensor& input, const torch::Tensor& condition);

 private:
  const bool bounded_;
  torch::nn::Linear first_{nullptr}, second_{nullptr}, mean_{nullptr}, log_variance_{nullptr};
};
TORCH_MODULE(LatentEncoder);

/// Latent and condition to features: three layers whose weights are a mixture of experts', blended
/// for each row by a gate. Since layers are linear, the experts' answers are blended instead.
class MixtureDecoderImpl : public torch::nn::Module {
 public:
  MixtureDecoderImpl(int64_t condition, int64_t output, const BodyConfig& config);
  torch::Tensor forward(const torch::Tensor& latent, const torch::Tensor& condition);

 private:
  torch::Tensor Blend(torch::nn::Linear& layer, const torch::Tensor& input,
                      const torch::Tensor& shares) const;

  const int64_t experts_;
  torch::nn::Linear gate_first_{nullptr}, gate_second_{nullptr}, gate_out_{nullptr};
  torch::nn::Linear first_{nullptr}, second_{nullptr}, out_{nullptr};  // all experts side by side
};
TORCH_MODULE(MixtureDecoder);

/// A part of the body from one frame to the next: encoder and decoder of the CVAE. All rows are
/// normalised. Source: reference sec. 7.
class PartCvaeImpl : public torch::nn::Module {
 public:
  PartCvaeImpl(int64_t features, int64_t condition, const BodyConfig& config)
      : encoder(register_module("encoder", LatentEncoder(features, condition, config, false))),
        decoder(register_module("decoder", MixtureDecoder(condition, features, config))) {}

  LatentEncoder encoder;
  MixtureDecoder decoder;
};
TORCH_MODULE(PartCvae);

/// Mean over rows and latent of the divergence from a standard normal.
torch::Tensor Divergence(const LatentTensors& latent);

}  // namespace poise::push::ldp

#endif  // POISE_CORE_PUSH_LDP_PART_CVAE_H_
