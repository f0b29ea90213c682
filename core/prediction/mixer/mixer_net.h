#ifndef POISE_CORE_PREDICTION_MIXER_MIXER_NET_H_
#define POISE_CORE_PREDICTION_MIXER_MIXER_NET_H_

#include <torch/torch.h>

#include <vector>

#include "core/prediction/mixer/mixer_config.h"
#include "core/prediction/network_body.h"
#include "core/prediction/tensors/predictor_net.h"

namespace poise::prediction {

/// MixerPredictor's network, to be trained: a token per joint, made of the DCT coefficients of its
/// motion and of its last rotation; blocks mix between joints by free matrices, as the graphs of
/// LTD do (reference sec. 4.2), and then within each joint. Untrained it says that nothing changes.
/// Shapes: past (batch, past_frames, features), still (batch, still_features),
///         Forward (batch, future_frames, features); features as in mixer_config.h
class MixerNet : public PredictorNet {
 public:
  /// `measure` is the error to learn: of the body's joints alone.
  MixerNet(const MixerConfig& config, const NetworkBody& body, EulerMeasure measure);

  int past_frames() const override { return config_.past_frames; }
  int future_frames() const override { return config_.future_frames; }
  void Fit(const PoseTensors& windows) override;
  /// Mean error over frames, each weighed by what holding still would cost there; and a share of
  /// the error of the root.
  torch::Tensor Loss(const PoseTensors& windows) override;
  PoseTensors Predict(const PoseTensors& windows) override;

  torch::Tensor Forward(const torch::Tensor& past, const torch::Tensor& still);

 private:
  struct Block {
    torch::nn::LayerNorm joint_norm = nullptr;
    torch::Tensor joints;  // (groups, tokens, tokens)
    torch::nn::LayerNorm within_norm = nullptr;
    torch::nn::Linear up = nullptr, down = nullptr;
  };
  void Build();
  torch::Tensor MixJoints(Block& block, const torch::Tensor& h);
  torch::Tensor Changes(const PoseTensors& windows) const;  // (batch, frames, features)
  torch::Tensor Still(const PoseTensors& windows) const;
  torch::Tensor Turned(const PoseTensors& windows, const torch::Tensor& changes) const;
  torch::Tensor Drop(const torch::Tensor& x) const;

  const MixerConfig config_;
  const EulerMeasure measure_;
  const torch::Tensor joints_;  // (joints) int64
  torch::Tensor scale_;         // (features) typical size of a change
  torch::Tensor frame_weight_;  // (future_frames) mean 1
  torch::Tensor past_dct_, future_dct_;
  torch::nn::Linear joint_in_ = nullptr, root_in_ = nullptr;
  torch::Tensor names_;  // (tokens, width) tell joints apart; the root is the last
  std::vector<Block> blocks_;
  torch::nn::LayerNorm out_norm_ = nullptr;
  torch::nn::Linear joint_out_ = nullptr, root_out_ = nullptr;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_MIXER_MIXER_NET_H_
