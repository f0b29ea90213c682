#include "core/prediction/rnn/rnn_kernel.h"

#include "core/prediction/network/layer_kernels.h"

namespace poise::prediction::POISE_KERNEL_ISA {
namespace {

using Strided = Eigen::Map<Matrix, 0, Eigen::OuterStride<>>;
using ConstStrided = Eigen::Map<const Matrix, 0, Eigen::OuterStride<>>;

// One frame of `frames` of every sample: (batch, columns).
ConstStrided FrameOf(const RnnArguments& a, const float* rows, int frames, int frame) {
  return ConstStrided(rows + static_cast<long>(frame) * a.columns, a.batch, a.columns,
                      Eigen::OuterStride<>(static_cast<long>(frames) * a.columns));
}

// GRU as LibTorch has it; h is (batch, hidden).
void Step(const RnnArguments& a, const Eigen::Ref<const Matrix>& pose, Matrix& h, Matrix& gates,
          Matrix& from_state) {
  const long width = a.hidden;
  Apply(a.input, pose, gates);
  Apply(a.state, h, from_state);
  auto both = gates.leftCols(2 * width).array();  // reset and update
  both = 1 / (1 + (-(both + from_state.leftCols(2 * width).array())).exp());
  auto made = gates.rightCols(width).array();
  made = (made + gates.leftCols(width).array() * from_state.rightCols(width).array()).tanh();
  h.array() = made + gates.middleCols(width, width).array() * (h.array() - made);
}

}  // namespace

void RnnKernel(const RnnArguments& a) {
  Matrix h = Matrix::Zero(a.batch, a.hidden);
  Matrix gates(a.batch, 3 * a.hidden), from_state(a.batch, 3 * a.hidden);
  for (int frame = 0; frame < a.past - 1; ++frame) {
    Step(a, FrameOf(a, a.inputs, a.past, frame), h, gates, from_state);
  }
  Matrix pose = FrameOf(a, a.inputs, a.past, a.past - 1), change(a.batch, a.columns);
  for (int frame = 0; frame < a.future; ++frame) {
    Step(a, pose, h, gates, from_state);
    Apply(a.change, h, change);
    pose += change;
    Strided(a.outputs + static_cast<long>(frame) * a.columns, a.batch, a.columns,
            Eigen::OuterStride<>(static_cast<long>(a.future) * a.columns)) = pose;
  }
}

}  // namespace poise::prediction::POISE_KERNEL_ISA
