#ifndef POISE_CORE_PREDICTION_SIMLPE_SIMLPE_PREDICTOR_H_
#define POISE_CORE_PREDICTION_SIMLPE_SIMLPE_PREDICTOR_H_

#include <vector>

#include "core/base/tensor_file.h"
#include "core/prediction/network/column_predictor.h"
#include "core/prediction/simlpe/simlpe_config.h"
#include "core/prediction/simlpe/simlpe_kernel.h"

namespace poise::prediction {

/// siMLPe ("Back to MLP", Guo et al. 2023) without LibTorch: linear layers along time on DCT
/// coefficients. Source: reference sec. 4.4.
class SimlpePredictor : public ColumnPredictor<SimlpePredictor, SimlpeConfig, SimlpeArguments> {
 private:
  friend Base;
  using Base::Base;
  Status Load(const SimlpeConfig& config, const base::TensorFile& weights);
  static void (*Kernel())(const SimlpeArguments&);

  std::vector<SimlpeBlock> layers_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_SIMLPE_SIMLPE_PREDICTOR_H_
