#ifndef POISE_CORE_PREDICTION_GCN_GCN_PREDICTOR_H_
#define POISE_CORE_PREDICTION_GCN_GCN_PREDICTOR_H_

#include <vector>

#include "core/base/tensor_file.h"
#include "core/prediction/gcn/gcn_config.h"
#include "core/prediction/gcn/gcn_kernel.h"
#include "core/prediction/network/column_predictor.h"

namespace poise::prediction {

/// LTD ("Learning Trajectory Dependencies", Mao et al. 2019) without LibTorch: a node per column
/// of rotation vectors, of which the DCT coefficients over past and future are predicted.
/// Source: reference sec. 4.2.
class GcnPredictor : public ColumnPredictor<GcnPredictor, GcnConfig, GcnArguments> {
 private:
  friend Base;
  using Base::Base;
  Status Load(const GcnConfig& config, const base::TensorFile& weights);
  static void (*Kernel())(const GcnArguments&);

  std::vector<GraphLayer> layers_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_GCN_GCN_PREDICTOR_H_
