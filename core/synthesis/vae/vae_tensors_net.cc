#include "core/synthesis/vae/vae_tensors_net.h"

#include <algorithm>

#include "core/synthesis/vae/vae_loss_net.h"

namespace poise::synthesis {
namespace {

torch::Tensor VectorTensor(const motion::Vec3& v) {
  return torch::tensor({v.x(), v.y(), v.z()}, torch::kFloat64);
}

}  // namespace

MotionBatch StackMotions(const std::vector<const motion::PoseMatrix*>& motions, int frames,
                         const RootScale& root) {
  const auto count = static_cast<int64_t>(motions.size());
  const int64_t width = motions.front()->cols();
  torch::Tensor poses = torch::empty({count, frames, width});
  torch::Tensor lengths = torch::empty({count}, torch::kInt64);
  float* out = poses.data_ptr<float>();
  for (int64_t i = 0; i < count; ++i) {
    const motion::PoseMatrix& motion = *motions[i];
    const Eigen::Index length = std::min<Eigen::Index>(motion.rows(), frames);
    lengths.data_ptr<int64_t>()[i] = length;
    for (Eigen::Index t = 0; t < frames; ++t, out += width) {
      Eigen::RowVectorXd row = motion.row(std::min(t, length - 1));
      row.head<3>() = (row.head<3>() - root.mean.transpose()).cwiseQuotient(root.scale.transpose());
      std::copy(row.begin(), row.end(), out);
    }
  }
  return {poses, lengths};
}

motion::PoseMatrix UnstackMotion(const torch::Tensor& poses, int length, const RootScale& root) {
  const torch::Tensor numbers = poses.narrow(0, 0, length).to(torch::kFloat64).contiguous();
  motion::PoseMatrix matrix =
      Eigen::Map<const motion::PoseMatrix>(numbers.data_ptr<double>(), length, poses.size(1));
  for (Eigen::Index t = 0; t < length; ++t) {
    matrix.row(t).head<3>() =
        matrix.row(t).head<3>().cwiseProduct(root.scale.transpose()) + root.mean.transpose();
  }
  return matrix;
}

PoseError CompareMotions(const torch::Tensor& x, const torch::Tensor& y,
                         const torch::Tensor& lengths, const RootScale& root) {
  const torch::NoGradGuard no_gradient;
  const DecodedPoses a = DecodeColumns(x.to(torch::kFloat64));
  const DecodedPoses b = DecodeColumns(y.to(torch::kFloat64));
  const torch::Tensor valid = ValidFrames(lengths, x.size(1), a.positions.options());
  // |R_a - R_b|^2 = 8 sin^2(angle / 2): exact also for small angles, where a cosine is not.
  const torch::Tensor chord = (a.rotations - b.rotations).square().sum({-2, -1}).sqrt();
  const torch::Tensor angle = 2 * torch::asin((chord / std::sqrt(8.0)).clamp_max(1));
  const torch::Tensor distance =
      ((a.positions - b.positions) * VectorTensor(root.scale)).norm(2, -1);
  const torch::Tensor frames = valid.sum();
  return {((angle.mean(-1) * valid).sum() / frames).item<double>(),
          ((distance * valid).sum() / frames).item<double>()};
}

}  // namespace poise::synthesis
