#ifndef POISE_CORE_PREDICTION_RNN_RNN_NET_H_
#define POISE_CORE_PREDICTION_RNN_RNN_NET_H_

#include <torch/torch.h>

#include "core/prediction/rnn/rnn_config.h"
#include "core/prediction/tensors/column_tensors.h"

namespace poise::prediction {

/// RnnPredictor's network, to be trained: one GRU cell reads the past and then its own answers,
/// of which each is a change of the pose before. No gradient flows through a pose that is fed back.
/// Source: reference sec. 4.1.
class RnnNet : public ColumnNet {
 public:
  RnnNet(const RnnConfig& config, const NetworkBody& body, const EulerMeasure& measure);

  torch::Tensor Loss(const PoseTensors& windows) override;
  torch::Tensor Forward(const torch::Tensor& past) override;

 private:
  const RnnConfig config_;
  torch::nn::GRUCell cell_ = nullptr;
  torch::nn::Linear change_ = nullptr;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_RNN_RNN_NET_H_
