#include "core/push/ldp/part_cvae.h"

namespace poise::push::ldp {

using torch::Tensor;
using torch::nn::Linear;

LatentEncoderImpl::LatentEncoderImpl(int64_t input, int64_t condition, const BodyConfig& config,
                                     bool bounded)
    : bounded_(bounded) {
  const int64_t again = input + config.hidden;
  first_ = register_module("first", Linear(input + condition, config.hidden));
  second_ = register_module("second", Linear(again, config.hidden));
  mean_ = register_module("mean", Linear(again, config.latent));
  log_variance_ = register_module("log_variance", Linear(again, config.latent));
}

LatentTensors LatentEncoderImpl::forward(const Tensor& input, const Tensor& condition) {
  const Tensor first = torch::elu(first_(torch::cat({input, condition}, -1)));
  const Tensor second = torch::elu(second_(torch::cat({input, first}, -1)));
  const Tensor seen = torch::cat({input, second}, -1);
  const LatentTensors latent{mean_(seen), log_variance_(seen)};
  if (!bounded_) return latent;
  return {8 * latent.mean.sigmoid() - 4, 6.6 * latent.log_variance.sigmoid() - 6.4};
}

MixtureDecoderImpl::MixtureDecoderImpl(int64_t condition, int64_t output, const BodyConfig& config)
    : experts_(config.experts) {
  const int64_t seen = config.latent + condition, again = config.latent + config.hidden;
  gate_first_ = register_module("gate_first", Linear(seen, config.gate_hidden));
  gate_second_ = register_module("gate_second", Linear(config.gate_hidden, config.gate_hidden));
  gate_out_ = register_module("gate_out", Linear(config.gate_hidden, experts_));
  first_ = register_module("first", Linear(seen, experts_ * config.hidden));
  second_ = register_module("second", Linear(again, experts_ * config.hidden));
  out_ = register_module("out", Linear(again, experts_ * output));
}

Tensor MixtureDecoderImpl::Blend(Linear& layer, const Tensor& input, const Tensor& shares) const {
  const Tensor answers = layer(input).reshape({input.size(0), experts_, -1});
  return (answers * shares).sum(1);
}

Tensor MixtureDecoderImpl::forward(const Tensor& latent, const Tensor& condition) {
  const Tensor seen = torch::cat({latent, condition}, -1);
  const Tensor gate = gate_out_(torch::elu(gate_second_(torch::elu(gate_first_(seen)))));
  const Tensor shares = torch::softmax(gate, -1).unsqueeze(-1);
  const Tensor first = torch::elu(Blend(first_, seen, shares));
  const Tensor second = torch::elu(Blend(second_, torch::cat({latent, first}, -1), shares));
  return Blend(out_, torch::cat({latent, second}, -1), shares);
}

Tensor Divergence(const LatentTensors& latent) {
  return -0.5 * (1 + latent.log_variance - latent.mean.square() - latent.log_variance.exp()).mean();
}

}  // namespace poise::push::ldp
