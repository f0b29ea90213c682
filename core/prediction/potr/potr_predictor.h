#ifndef POISE_CORE_PREDICTION_POTR_POTR_PREDICTOR_H_
#define POISE_CORE_PREDICTION_POTR_POTR_PREDICTOR_H_

#include <memory>
#include <string>
#include <vector>

#include "core/base/tensor_file.h"
#include "core/prediction/network/pose_columns.h"
#include "core/prediction/potr/potr_config.h"
#include "core/prediction/potr/potr_kernel.h"

namespace poise::prediction {

/// POTR ("Pose transformers", Martinez-Gonzalez et al. 2021) without LibTorch.
/// Source: reference sec. 4.3.
class PotrPredictor : public ColumnPredictor {
 public:
  /// `weights`: parameters and buffers of PotrNet by their names. Errors: those of
  /// TensorFile::Floats and PoseColumns::Load.
  static StatusOr<std::shared_ptr<const PotrPredictor>> Create(const PotrConfig& config,
                                                               NetworkBody body,
                                                               const base::TensorFile& weights);

 private:
  PotrPredictor(const PotrConfig& config, NetworkBody body, PoseColumns columns);
  Status Load(const PotrConfig& config, const base::TensorFile& weights);
  Status LoadEmbedding(const base::TensorFile& weights);
  Status LoadEncoder(const base::TensorFile& weights, const std::string& name);
  Status LoadDecoder(const base::TensorFile& weights, const std::string& name);
  StatusOr<AttentionWeights> TakeAttention(const base::TensorFile& weights,
                                           const std::string& name);
  void Forward(int batch, const float* inputs, float* outputs) const override;

  NetworkWeights numbers_;
  PotrArguments arguments_ = {};  // but for the batch
  std::vector<PotrEncoderLayer> encoder_;
  std::vector<PotrDecoderLayer> decoder_;
  std::vector<float> positions_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_POTR_POTR_PREDICTOR_H_
