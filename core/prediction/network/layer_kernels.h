#ifndef POISE_CORE_PREDICTION_NETWORK_LAYER_KERNELS_H_
#define POISE_CORE_PREDICTION_NETWORK_LAYER_KERNELS_H_

// For files that are built per instruction set (POISE_KERNEL_ISA) alone.

// GCC 12 takes the operand that AVX-512 intrinsics leave unset for a variable in use.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <Eigen/Core>

#include "core/prediction/network/layers.h"

namespace poise::prediction::POISE_KERNEL_ISA {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using ConstMap = Eigen::Map<const Matrix>;
using Row = Eigen::Map<const Eigen::RowVectorXf>;

constexpr float kNormEpsilon = 1e-5f;  // as LibTorch's norms

inline ConstMap Weight(const LayerWeights& layer, Eigen::Index outputs, Eigen::Index inputs) {
  return ConstMap(layer.weight, outputs, inputs);
}

/// Normalises each row to mean 0 and deviation 1, then scales and shifts its columns; `out` has the
/// shape of `h`.
inline void Normalise(const Eigen::Ref<const Matrix>& h, const LayerWeights& norm,
                      Eigen::Ref<Matrix> out) {
  const float width = static_cast<float>(h.cols());
  out = h.colwise() - h.rowwise().mean();
  const Eigen::ArrayXf deviation =
      (out.rowwise().squaredNorm().array() / width + kNormEpsilon).sqrt();
  out.array().colwise() /= deviation;
  out.array().rowwise() *= Row(norm.weight, h.cols()).array();
  out.rowwise() += Row(norm.bias, h.cols());
}

/// A linear layer on each row.
inline void Apply(const LayerWeights& layer, const Eigen::Ref<const Matrix>& in,
                  Eigen::Ref<Matrix> out) {
  out.noalias() = in * Weight(layer, out.cols(), in.cols()).transpose();
  if (layer.bias != nullptr) out.rowwise() += Row(layer.bias, out.cols());
}

/// A graph layer on one sample: in (nodes, inputs). `product` is room for work.
inline void Convolve(const GraphLayer& layer, const Matrix& in, Matrix& product, Matrix& out) {
  product.noalias() = in * ConstMap(layer.weight, layer.inputs, layer.outputs);
  out.noalias() = ConstMap(layer.graph, in.rows(), in.rows()) * product;
  if (layer.bias != nullptr) out.rowwise() += Row(layer.bias, layer.outputs);
  if (layer.scale == nullptr) return;
  out.array() = (out.array() * ConstMap(layer.scale, out.rows(), out.cols()).array() +
                 ConstMap(layer.shift, out.rows(), out.cols()).array())
                    .tanh();
}

}  // namespace poise::prediction::POISE_KERNEL_ISA

#endif  // POISE_CORE_PREDICTION_NETWORK_LAYER_KERNELS_H_
