#ifndef POISE_CORE_PREDICTION_RNN_RNN_PREDICTOR_H_
#define POISE_CORE_PREDICTION_RNN_RNN_PREDICTOR_H_

#include "core/base/tensor_file.h"
#include "core/prediction/network/column_predictor.h"
#include "core/prediction/rnn/rnn_config.h"
#include "core/prediction/rnn/rnn_kernel.h"

namespace poise::prediction {

/// "On human motion prediction using recurrent neural networks" (Martinez et al. 2017) without
/// LibTorch. Source: reference sec. 4.1.
class RnnPredictor : public ColumnPredictor<RnnPredictor, RnnConfig, RnnArguments> {
 private:
  friend Base;
  using Base::Base;
  Status Load(const RnnConfig& config, const base::TensorFile& weights);
  static void (*Kernel())(const RnnArguments&);
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_RNN_RNN_PREDICTOR_H_
