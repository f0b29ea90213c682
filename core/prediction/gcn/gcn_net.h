#ifndef POISE_CORE_PREDICTION_GCN_GCN_NET_H_
#define POISE_CORE_PREDICTION_GCN_GCN_NET_H_

#include <torch/torch.h>

#include <memory>
#include <vector>

#include "core/prediction/gcn/gcn_config.h"
#include "core/prediction/tensors/column_tensors.h"
#include "core/prediction/tensors/graph_convolution.h"

namespace poise::prediction {

/// GcnPredictor's network, to be trained. Source: reference sec. 4.2.
class GcnNet : public ColumnNet {
 public:
  /// `measure` says which columns of the body's joints are nodes, and of which matrices.
  GcnNet(const GcnConfig& config, const NetworkBody& body, const EulerMeasure& measure);

  /// Mean over frames, observed ones too, of the sum over columns of the absolute error.
  torch::Tensor Loss(const PoseTensors& windows) override;
  torch::Tensor Forward(const torch::Tensor& past) override;

 private:
  torch::Tensor AllFrames(const torch::Tensor& past);  // the past's too

  const GcnConfig config_;
  torch::Tensor dct_;  // (coefficients, frames)
  std::vector<std::shared_ptr<GraphConvolution>> layers_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_GCN_GCN_NET_H_
