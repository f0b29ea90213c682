#ifndef POISE_CORE_SYNTHESIS_VAE_VAE_NET_H_
#define POISE_CORE_SYNTHESIS_VAE_VAE_NET_H_

#include <torch/torch.h>

#include "core/synthesis/vae/vae_config.h"

/// The networks of MotionAug's VAE. `frames` is the length T to which all sequences are brought by
/// repeating their last pose; `lengths` (batch) int64 tells how many are valid. A pose is `width`
/// numbers: root position, then 6D rotations.
/// Source: reference sec. 2.3. Where the paper says LSTM cells in all discriminators, the frame
/// discriminator is without one, as in the authors' program.
namespace poise::synthesis {

/// What one motion may have been drawn from: a diagonal Gaussian.
struct LatentGaussian {
  torch::Tensor mean;          // (batch, latent)
  torch::Tensor log_variance;  // (batch, latent)

  /// mean + deviation * noise. `noise` as mean.
  torch::Tensor Draw(const torch::Tensor& noise) const;
};

/// Motion to what each of its frames says, as VaeNetConfig::layers has it.
class FrameReader : public torch::nn::Module {
 public:
  FrameReader(const VaeNetConfig& config, int frames, int width);
  /// Numbers of a frame that come out: of both directions of an LSTM, or of one layer.
  static int Outputs(const VaeNetConfig& config);
  /// poses (batch, frames, width) -> (batch, frames, Outputs); zero behind a motion's end.
  torch::Tensor forward(const torch::Tensor& poses, const torch::Tensor& lengths);

 private:
  const int frequencies_;
  torch::nn::LayerNorm norm_;
  torch::nn::Linear embed_;
  torch::nn::LSTM lstm_{nullptr};                                        // of lstm
  torch::nn::Linear first_{nullptr}, clock_{nullptr}, second_{nullptr};  // of frames
};

/// Motion to Gaussian: what its frames say, averaged over the valid ones (LSTM: bidirectional).
class VaeEncoder : public torch::nn::Module {
 public:
  VaeEncoder(const VaeNetConfig& config, int frames, int width);
  /// poses (batch, frames, width)
  LatentGaussian forward(const torch::Tensor& poses, const torch::Tensor& lengths);

 private:
  std::shared_ptr<FrameReader> reader_;
  torch::nn::Sequential mean_, log_variance_;
};

/// Latent vector to motion: layers, or an LSTM, that see the same vector, and the clock, at every
/// frame.
class VaeDecoder : public torch::nn::Module {
 public:
  VaeDecoder(const VaeNetConfig& config, int frames, int width);
  /// z (batch, latent) -> the first `count` poses (batch, count, width) of `frames`.
  torch::Tensor forward(const torch::Tensor& z, int64_t count);
  /// Makes motions that are not learned yet stay near a pose (width).
  void StartAt(const torch::Tensor& pose);

 private:
  const int frames_;
  const int frequencies_;
  torch::nn::Linear embed_;
  torch::nn::LSTM lstm_{nullptr};                                        // of lstm
  torch::nn::Linear first_{nullptr}, clock_{nullptr}, second_{nullptr};  // of frames
  torch::nn::Sequential pose_;
};

/// Encoder, decoder and the estimator of a motion's length.
class VaeNet : public torch::nn::Module {
 public:
  VaeNet(const VaeNetConfig& config, int frames, int width);

  LatentGaussian Encode(const torch::Tensor& poses, const torch::Tensor& lengths) {
    return encoder_->forward(poses, lengths);
  }
  torch::Tensor Decode(const torch::Tensor& z) { return Decode(z, frames_); }
  torch::Tensor Decode(const torch::Tensor& z, int64_t count) {
    return decoder_->forward(z, count);
  }
  /// z -> frames (batch), not rounded.
  torch::Tensor EstimateLength(const torch::Tensor& z);
  /// Before it has learned anything: the pose (width) and the length that all motions are near to.
  void StartAt(const torch::Tensor& pose, double frames);

  int frames() const { return frames_; }

 private:
  const int frames_;
  std::shared_ptr<VaeEncoder> encoder_;
  std::shared_ptr<VaeDecoder> decoder_;
  torch::nn::Sequential length_;
};

/// Tells poses of real motions from made ones, frame by frame.
class FrameDiscriminator : public torch::nn::Module {
 public:
  FrameDiscriminator(const VaeNetConfig& config, int width);
  /// poses (batch, frames, width) -> verdicts (batch, frames, 1)
  torch::Tensor forward(const torch::Tensor& poses);

 private:
  torch::nn::Sequential layers_;
};

/// Tells whole motions: a bidirectional LSTM, its two last states side by side; of layers of single
/// frames the average of what they say.
class SequenceDiscriminator : public torch::nn::Module {
 public:
  SequenceDiscriminator(const VaeNetConfig& config, int frames, int width);
  /// poses (batch, frames, width) -> verdicts (batch, 1)
  torch::Tensor forward(const torch::Tensor& poses, const torch::Tensor& lengths);

 private:
  const int hidden_;
  const bool is_lstm_;
  std::shared_ptr<FrameReader> reader_;
  torch::nn::Sequential verdict_;
};

/// (batch, frames) of 1 where a frame is valid, in the type of the poses.
torch::Tensor ValidFrames(const torch::Tensor& lengths, int64_t frames,
                          const torch::TensorOptions& options);

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_VAE_VAE_NET_H_
