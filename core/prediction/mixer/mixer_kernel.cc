#include "core/prediction/mixer/mixer_kernel.h"

#include "core/prediction/network/layer_kernels.h"

namespace poise::prediction::POISE_KERNEL_ISA {
namespace {

// One block on the tokens of one sample; h is (tokens, width).
void AddBlock(const MixerSizes& sizes, const MixerBlock& block, Matrix& h, Matrix& normed,
              Matrix& wide) {
  const int tokens = sizes.joints + 1, shared = sizes.width / sizes.groups;
  Normalise(h, block.joint_norm, normed);
  for (int group = 0; group < sizes.groups; ++group) {
    h.middleCols(group * shared, shared).noalias() +=
        ConstMap(block.joints + group * tokens * tokens, tokens, tokens) *
        normed.middleCols(group * shared, shared);
  }
  Normalise(h, block.within_norm, normed);
  Apply(block.up, normed, wide);
  wide.array() = wide.array() / (1 + (-wide.array()).exp());  // x * sigmoid(x)
  h.noalias() += wide * Weight(block.down, sizes.width, sizes.hidden).transpose();
  h.rowwise() += Row(block.down.bias, sizes.width);
}

// What MixerNet's tokens are made of: joint_inputs (joints, 3 past + 6), root_inputs (1, 6 past +
// 3).
void GatherInputs(const MixerArguments& a, int sample, Matrix& joint_inputs, Matrix& root_inputs) {
  const MixerSizes& s = a.sizes;
  const long features = 3 * s.joints + 6, still_features = 6 * s.joints + 3;
  const float* past = a.inputs + sample * (s.past * features + still_features);
  const float* still = past + s.past * features;
  const Matrix coefficients =
      ConstMap(a.past_dct, s.past, s.past) * ConstMap(past, s.past, features);
  for (int frame = 0; frame < s.past; ++frame) {
    joint_inputs.middleCols(3 * frame, 3) = ConstMap(coefficients.row(frame).data(), s.joints, 3);
    root_inputs.middleCols(6 * frame, 6) = coefficients.row(frame).tail(6);
  }
  joint_inputs.rightCols(6) = ConstMap(still, s.joints, 6);
  root_inputs.rightCols(3) = Row(still + 6 * s.joints, 3);
}

}  // namespace

void MixerKernel(const MixerArguments& a) {
  const MixerSizes& s = a.sizes;
  const int tokens = s.joints + 1;
  const long features = 3 * s.joints + 6;
  Matrix joint_inputs(s.joints, 3 * s.past + 6), root_inputs(1, 6 * s.past + 3);
  Matrix h(tokens, s.width), normed(tokens, s.width), wide(tokens, s.hidden);
  Matrix turns(s.joints, 3 * s.future), path(1, 6 * s.future), out(s.future, features);
  for (int i = 0; i < a.batch; ++i) {
    GatherInputs(a, i, joint_inputs, root_inputs);
    Apply(a.joint_in, joint_inputs, h.topRows(s.joints));
    Apply(a.root_in, root_inputs, h.bottomRows(1));
    h += ConstMap(a.names, tokens, s.width);
    for (int b = 0; b < s.blocks; ++b) AddBlock(s, a.blocks[b], h, normed, wide);
    Normalise(h, a.out_norm, normed);
    Apply(a.joint_out, normed.topRows(s.joints), turns);
    Apply(a.root_out, normed.bottomRows(1), path);
    for (int frame = 0; frame < s.future; ++frame) {
      Eigen::Map<Matrix>(out.row(frame).data(), s.joints, 3) = turns.middleCols(3 * frame, 3);
      out.row(frame).tail(6) = path.middleCols(6 * frame, 6);
    }
    Eigen::Map<Matrix>(a.outputs + i * s.future * features, s.future, features).noalias() =
        ConstMap(a.future_dct, s.future, s.future).transpose() * out;
  }
}

}  // namespace poise::prediction::POISE_KERNEL_ISA
