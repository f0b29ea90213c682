#ifndef POISE_CORE_PREDICTION_SIMLPE_SIMLPE_NET_H_
#define POISE_CORE_PREDICTION_SIMLPE_SIMLPE_NET_H_

#include <torch/torch.h>

#include <vector>

#include "core/prediction/simlpe/simlpe_config.h"
#include "core/prediction/tensors/column_tensors.h"

namespace poise::prediction {

/// SimlpePredictor's network, to be trained. Untrained it says that nothing changes.
/// Source: reference sec. 4.4.
class SimlpeNet : public ColumnNet {
 public:
  SimlpeNet(const SimlpeConfig& config, const NetworkBody& body, const EulerMeasure& measure);

  /// Mean absolute error of columns and of their changes from frame to frame.
  torch::Tensor Loss(const PoseTensors& windows) override;
  torch::Tensor Forward(const torch::Tensor& past) override;

 private:
  struct Block {
    torch::nn::Linear along_time = nullptr;
    torch::nn::LayerNorm norm = nullptr;
  };
  const SimlpeConfig config_;
  torch::Tensor dct_;
  torch::nn::Linear in_ = nullptr, out_ = nullptr;
  std::vector<Block> blocks_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_SIMLPE_SIMLPE_NET_H_
