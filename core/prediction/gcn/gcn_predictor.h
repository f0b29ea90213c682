#ifndef POISE_CORE_PREDICTION_GCN_GCN_PREDICTOR_H_
#define POISE_CORE_PREDICTION_GCN_GCN_PREDICTOR_H_

#include <list>
#include <memory>
#include <string>
#include <vector>

#include "core/base/tensor_file.h"
#include "core/prediction/gcn/gcn_config.h"
#include "core/prediction/gcn/gcn_kernel.h"
#include "core/prediction/network_body.h"
#include "core/prediction/predictor.h"

namespace poise::prediction {

/// LTD ("Learning Trajectory Dependencies", Mao et al. 2019) without LibTorch: a node per rotation
/// vector column that moves in the training data, of which the DCT coefficients over past and
/// future are predicted. Other columns and the root are held. Source: reference sec. 4.2.
class GcnPredictor : public Predictor {
 public:
  /// `weights`: parameters and buffers of GcnNet by their names. Errors: those of
  /// TensorFile::Floats; kInvalidArgument MALFORMED_CARD without any column.
  static StatusOr<std::shared_ptr<const GcnPredictor>> Create(const GcnConfig& config,
                                                              NetworkBody body,
                                                              const base::TensorFile& weights);

  const PredictorSignature& signature() const override { return signature_; }
  StatusOr<std::vector<motion::Clip>> Predict(std::span<const Observation> batch, int future_frames,
                                              const base::RunContext& context) const override;

 private:
  GcnPredictor(const GcnConfig& config, NetworkBody body);
  Status Load(const base::TensorFile& weights);
  Status LoadLayer(const base::TensorFile& weights, int layer);
  const float* Keep(std::vector<float> numbers);

  void WriteMotion(const motion::Clip& past, float* motion) const;
  StatusOr<motion::Clip> Decode(const motion::Clip& past, const float* future,
                                int future_frames) const;

  const GcnConfig config_;
  const NetworkBody body_;
  PredictorSignature signature_;
  double sense_ = 1;          // of the learned vectors: -1 for transposed matrices
  std::vector<int> columns_;  // (nodes) 3 * index in body_.joints + axis
  GcnArguments arguments_ = {};
  std::vector<GcnLayer> layers_;
  std::list<std::vector<float>> numbers_;  // that the pointers point into
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_GCN_GCN_PREDICTOR_H_
