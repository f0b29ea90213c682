#include "core/prediction/mixer/mixer_kernel.h"

// GCC 12 takes the operand that AVX-512 intrinsics leave unset for a variable in use.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <Eigen/Core>

namespace poise::prediction::POISE_KERNEL_ISA {
namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using ConstMap = Eigen::Map<const Matrix>;
using Column = Eigen::Map<const Eigen::VectorXf>;
using Row = Eigen::Map<const Eigen::RowVectorXf>;

constexpr float kNormEpsilon = 1e-5f;  // as LibTorch's LayerNorm

ConstMap Weight(const MixerLayer& layer, int outputs, int inputs) {
  return ConstMap(layer.weight, outputs, inputs);
}

// Normalises each row to mean 0 and deviation 1, then scales and shifts its columns.
void Normalise(const Matrix& h, const MixerLayer& norm, Matrix& out) {
  const float width = static_cast<float>(h.cols());
  out = h.colwise() - h.rowwise().mean();
  const Eigen::ArrayXf deviation =
      (out.rowwise().squaredNorm().array() / width + kNormEpsilon).sqrt();
  out.array().colwise() /= deviation;
  out.array().rowwise() *= Row(norm.weight, h.cols()).array();
  out.rowwise() += Row(norm.bias, h.cols());
}

// One block on the time coefficients of one sample; h is (past, width).
void AddBlock(const MixerSizes& sizes, const MixerBlock& block, Matrix& h, Matrix& normed,
              Matrix& wide) {
  Normalise(h, block.time_norm, normed);
  h.noalias() += Weight(block.time, sizes.past, sizes.past) * normed;
  h.colwise() += Column(block.time.bias, sizes.past);
  Normalise(h, block.pose_norm, normed);
  wide.noalias() = normed * Weight(block.up, sizes.hidden, sizes.width).transpose();
  wide.rowwise() += Row(block.up.bias, sizes.hidden);
  wide.array() = wide.array() / (1 + (-wide.array()).exp());  // x * sigmoid(x)
  h.noalias() += wide * Weight(block.down, sizes.width, sizes.hidden).transpose();
  h.rowwise() += Row(block.down.bias, sizes.width);
}

}  // namespace

void MixerKernel(const MixerArguments& a) {
  const MixerSizes& s = a.sizes;
  Matrix h(s.past, s.width), normed(s.past, s.width), wide(s.past, s.hidden);
  Matrix coefficients(s.past, s.features), late(s.future, s.width), out(s.future, s.features);
  for (int i = 0; i < a.batch; ++i) {
    const ConstMap past(a.past + static_cast<long>(i) * s.past * s.features, s.past, s.features);
    coefficients.noalias() = ConstMap(a.past_dct, s.past, s.past) * past;
    h.noalias() = coefficients * Weight(a.past_in, s.width, s.features).transpose();
    const Eigen::RowVectorXf pose = Row(a.still + static_cast<long>(i) * s.still, s.still) *
                                    Weight(a.still_in, s.width, s.still).transpose();
    h.rowwise() += Row(a.past_in.bias, s.width) + Row(a.still_in.bias, s.width) + pose;
    for (int b = 0; b < s.blocks; ++b) AddBlock(s, a.blocks[b], h, normed, wide);
    Normalise(h, a.out_norm, normed);
    late.noalias() = Weight(a.time_out, s.future, s.past) * normed;
    late.colwise() += Column(a.time_out.bias, s.future);
    out.noalias() = late * Weight(a.pose_out, s.features, s.width).transpose();
    out.rowwise() += Row(a.pose_out.bias, s.features);
    Eigen::Map<Matrix>(a.future + static_cast<long>(i) * s.future * s.features, s.future,
                       s.features)
        .noalias() = ConstMap(a.future_dct, s.future, s.future).transpose() * out;
  }
}

}  // namespace poise::prediction::POISE_KERNEL_ISA
