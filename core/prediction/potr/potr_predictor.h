#ifndef POISE_CORE_PREDICTION_POTR_POTR_PREDICTOR_H_
#define POISE_CORE_PREDICTION_POTR_POTR_PREDICTOR_H_

#include <string>
#include <vector>

#include "core/base/tensor_file.h"
#include "core/prediction/network/column_predictor.h"
#include "core/prediction/potr/potr_config.h"
#include "core/prediction/potr/potr_kernel.h"

namespace poise::prediction {

/// POTR ("Pose transformers", Martinez-Gonzalez et al. 2021) without LibTorch.
/// Source: reference sec. 4.3.
class PotrPredictor : public ColumnPredictor<PotrPredictor, PotrConfig, PotrArguments> {
 private:
  friend Base;
  using Base::Base;
  Status Load(const PotrConfig& config, const base::TensorFile& weights);
  Status LoadEmbedding(const base::TensorFile& weights);
  Status LoadEncoder(const base::TensorFile& weights, const std::string& name);
  Status LoadDecoder(const base::TensorFile& weights, const std::string& name);
  StatusOr<AttentionWeights> TakeAttention(const base::TensorFile& weights,
                                           const std::string& name);
  static void (*Kernel())(const PotrArguments&);

  std::vector<PotrEncoderLayer> encoder_;
  std::vector<PotrDecoderLayer> decoder_;
  std::vector<float> positions_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_POTR_POTR_PREDICTOR_H_
