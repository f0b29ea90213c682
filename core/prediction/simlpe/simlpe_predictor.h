#ifndef POISE_CORE_PREDICTION_SIMLPE_SIMLPE_PREDICTOR_H_
#define POISE_CORE_PREDICTION_SIMLPE_SIMLPE_PREDICTOR_H_

#include <memory>
#include <vector>

#include "core/base/tensor_file.h"
#include "core/prediction/network/pose_columns.h"
#include "core/prediction/simlpe/simlpe_config.h"
#include "core/prediction/simlpe/simlpe_kernel.h"

namespace poise::prediction {

/// siMLPe ("Back to MLP", Guo et al. 2023) without LibTorch: linear layers along time on DCT
/// coefficients. Source: reference sec. 4.4.
class SimlpePredictor : public ColumnPredictor {
 public:
  /// `weights`: parameters and buffers of SimlpeNet by their names. Errors: those of
  /// TensorFile::Floats and PoseColumns::Load.
  static StatusOr<std::shared_ptr<const SimlpePredictor>> Create(const SimlpeConfig& config,
                                                                 NetworkBody body,
                                                                 const base::TensorFile& weights);

 private:
  SimlpePredictor(const SimlpeConfig& config, NetworkBody body, PoseColumns columns);
  Status Load(const SimlpeConfig& config, const base::TensorFile& weights);
  void Forward(int batch, const float* inputs, float* outputs) const override;

  NetworkWeights numbers_;
  SimlpeArguments arguments_ = {};  // but for the batch
  std::vector<SimlpeBlock> layers_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_SIMLPE_SIMLPE_PREDICTOR_H_
