#ifndef POISE_CORE_PREDICTION_RNN_RNN_PREDICTOR_H_
#define POISE_CORE_PREDICTION_RNN_RNN_PREDICTOR_H_

#include <memory>

#include "core/base/tensor_file.h"
#include "core/prediction/network/pose_columns.h"
#include "core/prediction/rnn/rnn_config.h"
#include "core/prediction/rnn/rnn_kernel.h"

namespace poise::prediction {

/// "On human motion prediction using recurrent neural networks" (Martinez et al. 2017) without
/// LibTorch. Source: reference sec. 4.1.
class RnnPredictor : public ColumnPredictor {
 public:
  /// `weights`: parameters and buffers of RnnNet by their names. Errors: those of
  /// TensorFile::Floats and PoseColumns::Load.
  static StatusOr<std::shared_ptr<const RnnPredictor>> Create(const RnnConfig& config,
                                                              NetworkBody body,
                                                              const base::TensorFile& weights);

 private:
  RnnPredictor(const RnnConfig& config, NetworkBody body, PoseColumns columns);
  Status Load(const RnnConfig& config, const base::TensorFile& weights);
  void Forward(int batch, const float* inputs, float* outputs) const override;

  NetworkWeights numbers_;
  RnnArguments arguments_ = {};  // but for the batch
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_RNN_RNN_PREDICTOR_H_
