#ifndef POISE_CORE_PREDICTION_GCN_GCN_PREDICTOR_H_
#define POISE_CORE_PREDICTION_GCN_GCN_PREDICTOR_H_

#include <memory>
#include <vector>

#include "core/base/tensor_file.h"
#include "core/prediction/gcn/gcn_config.h"
#include "core/prediction/gcn/gcn_kernel.h"
#include "core/prediction/network/pose_columns.h"

namespace poise::prediction {

/// LTD ("Learning Trajectory Dependencies", Mao et al. 2019) without LibTorch: a node per column
/// of rotation vectors, of which the DCT coefficients over past and future are predicted.
/// Source: reference sec. 4.2.
class GcnPredictor : public ColumnPredictor {
 public:
  /// `weights`: parameters and buffers of GcnNet by their names. Errors: those of
  /// TensorFile::Floats and PoseColumns::Load.
  static StatusOr<std::shared_ptr<const GcnPredictor>> Create(const GcnConfig& config,
                                                              NetworkBody body,
                                                              const base::TensorFile& weights);

 private:
  GcnPredictor(const GcnConfig& config, NetworkBody body, PoseColumns columns);
  Status Load(const GcnConfig& config, const base::TensorFile& weights);
  void Forward(int batch, const float* inputs, float* outputs) const override;

  NetworkWeights numbers_;
  GcnArguments arguments_ = {};  // but for the batch
  std::vector<GraphLayer> layers_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_GCN_GCN_PREDICTOR_H_
