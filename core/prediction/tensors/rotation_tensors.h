#ifndef POISE_CORE_PREDICTION_TENSORS_ROTATION_TENSORS_H_
#define POISE_CORE_PREDICTION_TENSORS_ROTATION_TENSORS_H_

#include <torch/torch.h>

/// Rotations in tensors, differentiable everywhere but at a half turn. Shapes: quaternions (..., 4)
/// w x y z of unit length, vectors (..., 3); leading dimensions broadcast.
namespace poise::prediction {

torch::Tensor Conjugate(const torch::Tensor& quaternion);
torch::Tensor Multiply(const torch::Tensor& a, const torch::Tensor& b);
/// Rotation vector of length [0, pi], and back.
torch::Tensor LogMap(const torch::Tensor& quaternion);
torch::Tensor ExpMap(const torch::Tensor& vector);
/// quaternion * vector
torch::Tensor Rotate(const torch::Tensor& quaternion, const torch::Tensor& vector);
/// First two columns of the matrix, one after the other: (..., 6).
torch::Tensor SixD(const torch::Tensor& quaternion);
/// The angles of motion::EulerOfRotationVector, of the rotation or (row_vectors) of its inverse.
torch::Tensor PaperEuler(const torch::Tensor& quaternion, bool row_vectors);

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_TENSORS_ROTATION_TENSORS_H_
