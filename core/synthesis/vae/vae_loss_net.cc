#include "core/synthesis/vae/vae_loss_net.h"

namespace poise::synthesis {
namespace {

constexpr int64_t kPosition = 3;
constexpr int64_t kSixD = 6;
// A column that an untrained network puts at zero must not become NaN.
constexpr double kShortest = 1e-8;

torch::Tensor Normalise(const torch::Tensor& v) {
  return v / v.norm(2, -1, /*keepdim=*/true).clamp_min(kShortest);
}

// (batch, frames) of squares, from both parts.
torch::Tensor SquaredPerFrame(const torch::Tensor& positions, const torch::Tensor& rotations) {
  return positions.square().sum(-1) + rotations.square().sum({-3, -2, -1});
}

torch::Tensor MaskedMean(const torch::Tensor& per_frame, const torch::Tensor& valid) {
  return ((per_frame * valid).sum(1) / valid.sum(1).clamp_min(1)).mean();
}

torch::Tensor SecondDifference(const torch::Tensor& x) {
  const int64_t frames = x.size(1);
  return x.narrow(1, 2, frames - 2) - 2 * x.narrow(1, 1, frames - 2) + x.narrow(1, 0, frames - 2);
}

}  // namespace

DecodedPoses DecodeColumns(const torch::Tensor& poses) {
  const int64_t joints = (poses.size(2) - kPosition) / kSixD;
  const torch::Tensor columns = poses.narrow(2, kPosition, joints * kSixD)
                                    .reshape({poses.size(0), poses.size(1), joints, 2, 3});
  const torch::Tensor a = columns.select(3, 0), b = columns.select(3, 1);
  const torch::Tensor x = Normalise(a);
  const torch::Tensor y = Normalise(b - (x * b).sum(-1, /*keepdim=*/true) * x);
  const torch::Tensor z = torch::cross(x, y, -1);
  return {poses.narrow(2, 0, kPosition), torch::stack({x, y, z}, -1)};
}

torch::Tensor ReconstructionLoss(const DecodedPoses& x, const DecodedPoses& y,
                                 const torch::Tensor& valid) {
  return MaskedMean(SquaredPerFrame(x.positions - y.positions, x.rotations - y.rotations), valid);
}

torch::Tensor SmoothnessLoss(const DecodedPoses& y, const torch::Tensor& valid) {
  if (valid.size(1) < 3) return torch::zeros({}, valid.options());
  const torch::Tensor per_frame =
      SquaredPerFrame(SecondDifference(y.positions), SecondDifference(y.rotations));
  // All three frames of a difference must count.
  return MaskedMean(per_frame, valid.narrow(1, 2, valid.size(1) - 2));
}

torch::Tensor KlLoss(const LatentGaussian& gaussian) {
  const torch::Tensor& log_variance = gaussian.log_variance;
  return 0.5 * (gaussian.mean.square() + log_variance.exp() - 1 - log_variance).sum(1).mean();
}

torch::Tensor LengthLoss(const torch::Tensor& predicted, const torch::Tensor& lengths) {
  return (predicted - lengths.to(predicted.options())).square().mean();
}

torch::Tensor DiscriminatorLoss(const torch::Tensor& real, const torch::Tensor& made) {
  return 0.5 * (torch::relu(1 - real).mean() + torch::relu(1 + made).mean());
}

}  // namespace poise::synthesis
