#ifndef POISE_CORE_PREDICTION_TENSORS_ENSEMBLE_NET_H_
#define POISE_CORE_PREDICTION_TENSORS_ENSEMBLE_NET_H_

#include <torch/torch.h>

#include <memory>
#include <vector>

#include "core/prediction/tensors/predictor_net.h"

namespace poise::prediction {

/// EnsemblePredictor's networks, to be trained side by side: modules "member0", "member1", ...
/// Each learns from windows of its own, so that they err differently.
class EnsembleNet : public PredictorNet {
 public:
  /// Precondition: at least one member, all of one shape.
  explicit EnsembleNet(std::vector<std::shared_ptr<PredictorNet>> members);

  int past_frames() const override { return members_.front()->past_frames(); }
  int future_frames() const override { return members_.front()->future_frames(); }
  void Fit(const PoseTensors& windows) override;
  /// Sum over members, of which each takes an equal part of the windows.
  torch::Tensor Loss(const PoseTensors& windows) override;
  PoseTensors Predict(const PoseTensors& windows) override;

 private:
  const std::vector<std::shared_ptr<PredictorNet>> members_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_TENSORS_ENSEMBLE_NET_H_
