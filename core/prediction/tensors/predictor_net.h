#ifndef POISE_CORE_PREDICTION_TENSORS_PREDICTOR_NET_H_
#define POISE_CORE_PREDICTION_TENSORS_PREDICTOR_NET_H_

#include <torch/torch.h>

#include "core/prediction/tensors/pose_windows.h"

namespace poise::prediction {

/// A family's network while it is trained and compared: poses in, poses out, whatever numbers it
/// works on inside.
class PredictorNet : public torch::nn::Module {
 public:
  virtual int past_frames() const = 0;
  virtual int future_frames() const = 0;

  /// Takes from windows of the training set what is no weight: scales of inputs and losses.
  virtual void Fit(const PoseTensors& windows) = 0;
  /// What training makes small, on windows of past_frames() + future_frames(): of their future what
  /// was recorded. A scalar.
  virtual torch::Tensor Loss(const PoseTensors& windows) = 0;
  /// The future after the first past_frames() of the windows.
  virtual PoseTensors Predict(const PoseTensors& windows) = 0;
};

/// Euler error of the published kind per window and frame, with the columns that count; and of
/// every window only those that move in the target where `moving_only`. Shapes: predicted, target
/// (batch, frames, joints, 4); counts (joints * 3); result (batch, frames)
struct EulerMeasure {
  bool row_vectors = false;
  bool moving_only = false;
  torch::Tensor counts;

  torch::Tensor Errors(const torch::Tensor& predicted, const torch::Tensor& target) const;
  /// The same with differences wrapped to half a turn and a slope everywhere, to learn from.
  torch::Tensor SmoothErrors(const torch::Tensor& predicted, const torch::Tensor& target) const;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_TENSORS_PREDICTOR_NET_H_
