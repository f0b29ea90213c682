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

torch::Tensor LastBias(const nn::Sequential& layers) {
  return layers->ptr(layers->size() - 1)->as<nn::Linear>()->bias;
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

bool IsLstm(const VaeNetConfig& config) { return config.layers == "lstm"; }

// What the clock adds to a layer of single frames.
nn::Linear ClockLayer(const VaeNetConfig& config) {
  return nn::Linear(nn::LinearOptions(2 * config.clock, config.hidden).bias(false));
}

// Each pose beside its change to the next one, which for the last is 0; brought to like size.
torch::Tensor WithChanges(const torch::Tensor& poses, const torch::Tensor& lengths) {
  constexpr double kScale = 10;
  const int64_t frames = poses.size(1);
  const torch::Tensor next =
      torch::cat({poses.narrow(1, 1, frames - 1), poses.narrow(1, frames - 1, 1)}, 1);
  const torch::Tensor has_next = ValidFrames(lengths - 1, frames, poses.options()).unsqueeze(2);
  return torch::cat({poses, kScale * has_next * (next - poses)}, 2);
}

// (batch, frames, width) that is zero behind the end -> mean over valid frames (batch, width).
torch::Tensor AverageFrames(const torch::Tensor& outputs, const torch::Tensor& lengths) {
  return outputs.sum(1) / lengths.unsqueeze(1).to(outputs.options());
}

}  // namespace

torch::Tensor LatentGaussian::Draw(const torch::Tensor& noise) const {
  return mean + torch::exp(0.5 * log_variance) * noise;
}

torch::Tensor ValidFrames(const torch::Tensor& lengths, int64_t frames,
                          const torch::TensorOptions& options) {
  return torch::arange(frames).unsqueeze(0).lt(lengths.unsqueeze(1)).to(options);
}

FrameReader::FrameReader(const VaeNetConfig& config, int frames, int width)
    : frequencies_(config.clock),
      norm_(register_module("norm", SlabNorm(frames, width))),
      embed_(register_module("embed",
                             nn::Linear(IsLstm(config) ? width : 2 * width, config.embedding))) {
  if (IsLstm(config)) {
    lstm_ = register_module("lstm", MakeLstm(config.embedding, config.hidden, true));
    return;
  }
  first_ = register_module("first", nn::Linear(config.embedding, config.hidden));
  clock_ = register_module("clock", ClockLayer(config));
  second_ = register_module("second", nn::Linear(config.hidden, config.hidden));
}

int FrameReader::Outputs(const VaeNetConfig& config) {
  return IsLstm(config) ? 2 * config.hidden : config.hidden;
}

torch::Tensor FrameReader::forward(const torch::Tensor& poses, const torch::Tensor& lengths) {
  const torch::Tensor normed = norm_->forward(poses);
  if (!lstm_.is_empty()) {
    return learning::RunLstm(lstm_, torch::relu(embed_->forward(normed)), lengths);
  }
  const torch::Tensor embedded = torch::relu(embed_->forward(WithChanges(normed, lengths)));
  const torch::Tensor clock = clock_->forward(Clock(poses.size(1), frequencies_, poses.options()));
  const torch::Tensor said =
      torch::relu(second_->forward(torch::relu(first_->forward(embedded) + clock)));
  return said * ValidFrames(lengths, poses.size(1), poses.options()).unsqueeze(2);
}

VaeEncoder::VaeEncoder(const VaeNetConfig& config, int frames, int width)
    : reader_(register_module("reader", std::make_shared<FrameReader>(config, frames, width))),
      mean_(register_module("mean",
                            TwoLayers(FrameReader::Outputs(config), config.hidden, config.latent))),
      log_variance_(register_module(
          "log_variance", TwoLayers(FrameReader::Outputs(config), config.hidden, config.latent))) {}

LatentGaussian VaeEncoder::forward(const torch::Tensor& poses, const torch::Tensor& lengths) {
  const torch::Tensor average = AverageFrames(reader_->forward(poses, lengths), lengths);
  return {mean_->forward(average), log_variance_->forward(average)};
}

VaeDecoder::VaeDecoder(const VaeNetConfig& config, int frames, int width)
    : frames_(frames),
      frequencies_(config.clock),
      embed_(register_module("embed", nn::Linear(config.latent, config.embedding))),
      pose_(register_module("pose", TwoLayers(config.hidden, config.embedding, width))) {
  if (IsLstm(config)) {
    lstm_ = register_module("lstm",
                            MakeLstm(config.embedding + 2 * config.clock, config.hidden, false));
    return;
  }
  first_ = register_module("first", nn::Linear(config.embedding, config.hidden));
  clock_ = register_module("clock", ClockLayer(config));
  second_ = register_module("second", nn::Linear(config.hidden, config.hidden));
}

torch::Tensor VaeDecoder::forward(const torch::Tensor& z, int64_t count) {
  const torch::Tensor input = torch::relu(embed_->forward(z));
  const auto clock = [&] { return Clock(frames_, frequencies_, z.options()).narrow(0, 0, count); };
  if (lstm_.is_empty()) {
    const torch::Tensor first =
        torch::relu(first_->forward(input).unsqueeze(1) + clock_->forward(clock()));
    return pose_->forward(torch::relu(second_->forward(first)));
  }
  torch::Tensor inputs = input.unsqueeze(1).expand({z.size(0), count, input.size(1)});
  if (frequencies_ > 0) {
    inputs = torch::cat({inputs, clock().unsqueeze(0).expand({z.size(0), count, -1})}, 2);
  }
  return pose_->forward(learning::RunLstm(lstm_, inputs));
}

void VaeDecoder::StartAt(const torch::Tensor& pose) {
  const torch::NoGradGuard no_gradient;
  LastBias(pose_).copy_(pose);
}

VaeNet::VaeNet(const VaeNetConfig& config, int frames, int width)
    : frames_(frames),
      encoder_(register_module("encoder", std::make_shared<VaeEncoder>(config, frames, width))),
      decoder_(register_module("decoder", std::make_shared<VaeDecoder>(config, frames, width))),
      length_(register_module("length", TwoLayers(config.latent, config.length_hidden, 1))) {}

torch::Tensor VaeNet::EstimateLength(const torch::Tensor& z) {
  return frames_ - length_->forward(z).squeeze(1);
}

void VaeNet::StartAt(const torch::Tensor& pose, double frames) {
  decoder_->StartAt(pose);
  const torch::NoGradGuard no_gradient;
  LastBias(length_).fill_(frames_ - frames);
}

FrameDiscriminator::FrameDiscriminator(const VaeNetConfig& config, int width)
    : layers_(register_module("layers", TwoLayers(width, config.embedding, 1))) {}

torch::Tensor FrameDiscriminator::forward(const torch::Tensor& poses) {
  return layers_->forward(poses);
}

SequenceDiscriminator::SequenceDiscriminator(const VaeNetConfig& config, int frames, int width)
    : hidden_(config.hidden),
      is_lstm_(IsLstm(config)),
      reader_(register_module("reader", std::make_shared<FrameReader>(config, frames, width))),
      verdict_(register_module("verdict",
                               TwoLayers(FrameReader::Outputs(config), config.embedding, 1))) {}

torch::Tensor SequenceDiscriminator::forward(const torch::Tensor& poses,
                                             const torch::Tensor& lengths) {
  const torch::Tensor outputs = reader_->forward(poses, lengths);
  if (!is_lstm_) return verdict_->forward(AverageFrames(outputs, lengths));
  // The forward direction has seen all at the last valid frame, the backward one at the first.
  const torch::Tensor last = (lengths - 1).view({-1, 1, 1}).expand({-1, 1, hidden_});
  const torch::Tensor forward = outputs.narrow(2, 0, hidden_).gather(1, last).squeeze(1);
  const torch::Tensor backward = outputs.narrow(2, hidden_, hidden_).select(1, 0);
  return verdict_->forward(torch::cat({forward, backward}, 1));
}

}  // namespace poise::synthesis
