#include "core/synthesis/vae/vae_net.h"

#include <numbers>

#include "core/learning/nn/lstm.h"

namespace poise::synthesis {
namespace {

namespace nn = torch::nn;

nn::LSTM MakeLstm(int inputs, int hidden, bool bidirectional) {
  return nn::LSTM(nn::LSTMOptions(inputs, hidden).batch_first(true).bidirectional(bidirectional));
}

nn::Sequential TwoLayers(int inputs, int hidden, int outputs) {
  return nn::Sequential(nn::Linear(inputs, hidden), nn::ReLU(), nn::Linear(hidden, outputs));
}

nn::LayerNorm SlabNorm(int frames, int width) {
  return nn::LayerNorm(nn::LayerNormOptions({frames, width}));
}

// (frames, 2 * frequencies): sine and cosine of 1, 2, 4, ... half turns over the frames.
torch::Tensor Clock(int64_t frames, int64_t frequencies, const torch::TensorOptions& options) {
  const torch::Tensor turns = torch::pow(2, torch::arange(frequencies, options));
  const torch::Tensor angles = std::numbers::pi / static_cast<double>(frames) *
                               torch::arange(frames, options).unsqueeze(1) * turns.unsqueeze(0);
  return torch::cat({angles.sin(), angles.cos()}, 1);
}

}  // namespace

torch::Tensor LatentGaussian::Draw(const torch::Tensor& noise) const {
  return mean + torch::exp(0.5 * log_variance) * noise;
}

torch::Tensor ValidFrames(const torch::Tensor& lengths, int64_t frames,
                          const torch::TensorOptions& options) {
  return torch::arange(frames).unsqueeze(0).lt(lengths.unsqueeze(1)).to(options);
}

VaeEncoder::VaeEncoder(const VaeNetConfig& config, int frames, int width)
    : norm_(register_module("norm", SlabNorm(frames, width))),
      embed_(register_module("embed", nn::Linear(width, config.embedding))),
      lstm_(register_module("lstm", MakeLstm(config.embedding, config.hidden, true))),
      mean_(register_module("mean", TwoLayers(2 * config.hidden, config.hidden, config.latent))),
      log_variance_(register_module("log_variance",
                                    TwoLayers(2 * config.hidden, config.hidden, config.latent))) {}

LatentGaussian VaeEncoder::forward(const torch::Tensor& poses, const torch::Tensor& lengths) {
  const torch::Tensor outputs =
      learning::RunLstm(lstm_, torch::relu(embed_->forward(norm_->forward(poses))), lengths);
  const torch::Tensor average = outputs.sum(1) / lengths.unsqueeze(1).to(poses.options());
  return {mean_->forward(average), log_variance_->forward(average)};
}

VaeDecoder::VaeDecoder(const VaeNetConfig& config, int frames, int width)
    : frames_(frames),
      frequencies_(config.clock),
      embed_(register_module("embed", nn::Linear(config.latent, config.embedding))),
      lstm_(register_module("lstm",
                            MakeLstm(config.embedding + 2 * config.clock, config.hidden, false))),
      pose_(register_module("pose", TwoLayers(config.hidden, config.embedding, width))) {}

torch::Tensor VaeDecoder::forward(const torch::Tensor& z, int64_t count) {
  const torch::Tensor input = torch::relu(embed_->forward(z));
  torch::Tensor inputs = input.unsqueeze(1).expand({z.size(0), count, input.size(1)});
  if (frequencies_ > 0) {
    const torch::Tensor clock = Clock(frames_, frequencies_, z.options()).narrow(0, 0, count);
    inputs = torch::cat({inputs, clock.unsqueeze(0).expand({z.size(0), count, -1})}, 2);
  }
  return pose_->forward(learning::RunLstm(lstm_, inputs));
}

VaeNet::VaeNet(const VaeNetConfig& config, int frames, int width)
    : frames_(frames),
      encoder_(register_module("encoder", std::make_shared<VaeEncoder>(config, frames, width))),
      decoder_(register_module("decoder", std::make_shared<VaeDecoder>(config, frames, width))),
      length_(register_module("length", TwoLayers(config.latent, config.length_hidden, 1))) {}

torch::Tensor VaeNet::EstimateLength(const torch::Tensor& z) {
  return frames_ - length_->forward(z).squeeze(1);
}

FrameDiscriminator::FrameDiscriminator(const VaeNetConfig& config, int width)
    : layers_(register_module("layers", TwoLayers(width, config.embedding, 1))) {}

torch::Tensor FrameDiscriminator::forward(const torch::Tensor& poses) {
  return layers_->forward(poses);
}

SequenceDiscriminator::SequenceDiscriminator(const VaeNetConfig& config, int frames, int width)
    : hidden_(config.hidden),
      norm_(register_module("norm", SlabNorm(frames, width))),
      embed_(register_module("embed", nn::Linear(width, config.embedding))),
      lstm_(register_module("lstm", MakeLstm(config.embedding, config.hidden, true))),
      verdict_(register_module("verdict", TwoLayers(2 * config.hidden, config.embedding, 1))) {}

torch::Tensor SequenceDiscriminator::forward(const torch::Tensor& poses,
                                             const torch::Tensor& lengths) {
  const torch::Tensor outputs =
      learning::RunLstm(lstm_, torch::relu(embed_->forward(norm_->forward(poses))), lengths);
  // The forward direction has seen all at the last valid frame, the backward one at the first.
  const torch::Tensor last = (lengths - 1).view({-1, 1, 1}).expand({-1, 1, hidden_});
  const torch::Tensor forward = outputs.narrow(2, 0, hidden_).gather(1, last).squeeze(1);
  const torch::Tensor backward = outputs.narrow(2, hidden_, hidden_).select(1, 0);
  return verdict_->forward(torch::cat({forward, backward}, 1));
}

}  // namespace poise::synthesis
