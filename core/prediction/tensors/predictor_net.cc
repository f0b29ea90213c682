#include "core/prediction/tensors/predictor_net.h"

#include "core/prediction/tensors/rotation_tensors.h"

namespace poise::prediction {
namespace {

using torch::Tensor;

constexpr double kMovingDeviation = 1e-4;  // [rad]
constexpr double kTiny = 1e-8;

}  // namespace

Tensor EulerMeasure::Errors(const Tensor& predicted, const Tensor& target) const {
  const Tensor wanted = PaperEuler(target, row_vectors).flatten(2);
  Tensor difference = (PaperEuler(predicted, row_vectors).flatten(2) - wanted) * counts;
  if (moving_only) {
    const Tensor deviation = (wanted - wanted.mean(1, true)).square().mean(1, true).sqrt();
    difference = difference * (deviation > kMovingDeviation).to(torch::kFloat);
  }
  return difference.square().sum(-1).sqrt();
}

Tensor EulerMeasure::SmoothErrors(const Tensor& predicted, const Tensor& target) const {
  const Tensor difference =
      PaperEuler(predicted, row_vectors).flatten(2) - PaperEuler(target, row_vectors).flatten(2);
  const Tensor wrapped = torch::atan2(difference.sin(), difference.cos()) * counts;
  return (wrapped.square().sum(-1) + kTiny).sqrt();
}

}  // namespace poise::prediction
