#include "core/prediction/tensors/rotation_tensors.h"

namespace poise::prediction {
namespace {

using torch::Tensor;

constexpr double kTiny = 1e-12;       // keeps square roots away from 0, where they have no slope
constexpr double kNearGimbal = 1e-6;  // an arc sine has no slope at 1

Tensor Part(const Tensor& tensor, int64_t i) { return tensor.select(-1, i); }

}  // namespace

Tensor Conjugate(const Tensor& quaternion) {
  return quaternion * torch::tensor({1.0F, -1.0F, -1.0F, -1.0F});
}

Tensor Multiply(const Tensor& a, const Tensor& b) {
  const Tensor aw = Part(a, 0), ax = Part(a, 1), ay = Part(a, 2), az = Part(a, 3);
  const Tensor bw = Part(b, 0), bx = Part(b, 1), by = Part(b, 2), bz = Part(b, 3);
  return torch::stack(
      {aw * bw - ax * bx - ay * by - az * bz, aw * bx + ax * bw + ay * bz - az * by,
       aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw},
      -1);
}

Tensor LogMap(const Tensor& quaternion) {
  const Tensor shortest =
      torch::where(Part(quaternion, 0).unsqueeze(-1) < 0, -quaternion, quaternion);
  const Tensor imaginary = shortest.slice(-1, 1, 4);
  const Tensor sine = (imaginary.square().sum(-1, true) + kTiny).sqrt();
  return imaginary * (2 * torch::atan2(sine, shortest.slice(-1, 0, 1)) / sine);
}

Tensor ExpMap(const Tensor& vector) {
  const Tensor half = (vector.square().sum(-1, true) + kTiny).sqrt() / 2;
  return torch::cat({half.cos(), vector * (half.sin() / (2 * half))}, -1);
}

Tensor Rotate(const Tensor& quaternion, const Tensor& vector) {
  const Tensor imaginary = quaternion.slice(-1, 1, 4).expand_as(vector);
  const Tensor twice = 2 * torch::cross(imaginary, vector, -1);
  return vector + quaternion.slice(-1, 0, 1) * twice + torch::cross(imaginary, twice, -1);
}

Tensor SixD(const Tensor& quaternion) {
  const Tensor w = Part(quaternion, 0), x = Part(quaternion, 1), y = Part(quaternion, 2),
               z = Part(quaternion, 3);
  return torch::stack({1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y),
                       2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                      -1);
}

Tensor PaperEuler(const Tensor& quaternion, bool row_vectors) {
  const Tensor q = row_vectors ? Conjugate(quaternion) : quaternion;
  const Tensor w = Part(q, 0), x = Part(q, 1), y = Part(q, 2), z = Part(q, 3);
  const Tensor m00 = 1 - 2 * (y * y + z * z), m01 = 2 * (x * y - w * z), m02 = 2 * (x * z + w * y),
               m12 = 2 * (y * z - w * x), m22 = 1 - 2 * (x * x + y * y);
  return torch::stack(
      {torch::atan2(m12, m22), -torch::asin(m02.clamp(-1 + kNearGimbal, 1 - kNearGimbal)),
       torch::atan2(m01, m00)},
      -1);
}

}  // namespace poise::prediction
