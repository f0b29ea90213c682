#ifndef POISE_CORE_PREDICTION_GCN_GCN_NET_H_
#define POISE_CORE_PREDICTION_GCN_GCN_NET_H_

#include <torch/torch.h>

#include <vector>

#include "core/prediction/gcn/gcn_config.h"
#include "core/prediction/network_body.h"
#include "core/prediction/tensors/predictor_net.h"

namespace poise::prediction {

/// GcnPredictor's network, to be trained. Source: reference sec. 4.2.
/// Shapes: Forward (batch, frames, nodes) to the same
class GcnNet : public PredictorNet {
 public:
  /// `measure` says which columns of the body's joints are nodes, and of which matrices.
  GcnNet(const GcnConfig& config, const NetworkBody& body, const EulerMeasure& measure);

  int past_frames() const override { return config_.past_frames; }
  int future_frames() const override { return config_.future_frames; }
  void Fit(const PoseTensors&) override {}  // LTD takes the columns as they are
  /// Mean over frames, observed ones too, of the sum over columns of the absolute error.
  torch::Tensor Loss(const PoseTensors& windows) override;
  PoseTensors Predict(const PoseTensors& windows) override;

  torch::Tensor Forward(const torch::Tensor& motion);

 private:
  struct Layer {
    torch::Tensor graph, weight, bias;
    torch::nn::BatchNorm1d norm = nullptr;  // of the last layer none
  };
  torch::Tensor Vectors(const torch::Tensor& rotations) const;  // (batch, frames, joints * 3)
  torch::Tensor Padded(const torch::Tensor& vectors) const;     // the last past frame repeated
  torch::Tensor Convolve(const Layer& layer, const torch::Tensor& x) const;
  torch::Tensor Bend(Layer& layer, const torch::Tensor& x);

  const GcnConfig config_;
  const torch::Tensor joints_;   // (joints) int64
  const torch::Tensor columns_;  // (nodes) int64
  torch::Tensor sense_, counts_, dct_;
  std::vector<Layer> layers_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_GCN_GCN_NET_H_
