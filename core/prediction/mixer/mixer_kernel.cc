#include "core/prediction/mixer/mixer_kernel.h"

#include <algorithm>

#include "core/prediction/network/layer_kernels.h"

namespace poise::prediction::POISE_KERNEL_ISA {
namespace {

// Samples whose tokens go through the perceptrons together. A product packs its weights first,
// which for the tokens of one sample costs a good part of the product; more samples than these
// leave the second level cache.
constexpr int kSamples = 8;

// One block on the tokens of some samples; h is (samples, tokens, width).
void AddBlock(const MixerSizes& sizes, const MixerBlock& block, Eigen::Ref<Matrix> h,
              Eigen::Ref<Matrix> normed, Eigen::Ref<Matrix> wide) {
  const int tokens = sizes.joints + 1, shared = sizes.width / sizes.groups;
  Normalise(h, block.joint_norm, normed);
  for (int first = 0; first < h.rows(); first += tokens) {
    for (int group = 0; group < sizes.groups; ++group) {
      h.block(first, group * shared, tokens, shared).noalias() +=
          ConstMap(block.joints + group * tokens * tokens, tokens, tokens) *
          normed.block(first, group * shared, tokens, shared);
    }
  }
  Normalise(h, block.within_norm, normed);
  Apply(block.up, normed, wide);
  wide.array() = wide.array() / (1 + (-wide.array()).exp());  // x * sigmoid(x)
  h.noalias() += wide * Weight(block.down, sizes.width, sizes.hidden).transpose();
  h.rowwise() += Row(block.down.bias, sizes.width);
}

// What MixerNet's tokens are made of: joint_inputs (joints, 3 past + 6), root_inputs (1, 6 past +
// 3).
void GatherInputs(const MixerArguments& a, int sample, Eigen::Ref<Matrix> joint_inputs,
                  Eigen::Ref<Matrix> root_inputs) {
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
  const int tokens = s.joints + 1, most = std::min(a.batch, kSamples);
  const long features = 3 * s.joints + 6;
  Matrix joint_inputs(most * s.joints, 3 * s.past + 6), root_inputs(most, 6 * s.past + 3);
  Matrix joint_tokens(most * s.joints, s.width), root_tokens(most, s.width);
  Matrix all_h(most * tokens, s.width), all_normed(most * tokens, s.width);
  Matrix all_wide(most * tokens, s.hidden);
  Matrix all_turns(most * tokens, 3 * s.future), all_paths(most, 6 * s.future);
  Matrix out(s.future, features);
  for (int first = 0; first < a.batch; first += kSamples) {
    const int samples = std::min(kSamples, a.batch - first), rows = samples * tokens;
    auto h = all_h.topRows(rows), normed = all_normed.topRows(rows);
    for (int i = 0; i < samples; ++i) {
      GatherInputs(a, first + i, joint_inputs.middleRows(i * s.joints, s.joints),
                   root_inputs.middleRows(i, 1));
    }
    Apply(a.joint_in, joint_inputs.topRows(samples * s.joints),
          joint_tokens.topRows(samples * s.joints));
    Apply(a.root_in, root_inputs.topRows(samples), root_tokens.topRows(samples));
    for (int i = 0; i < samples; ++i) {
      auto own = h.middleRows(i * tokens, tokens);
      own = ConstMap(a.names, tokens, s.width);
      own.topRows(s.joints) += joint_tokens.middleRows(i * s.joints, s.joints);
      own.bottomRows(1) += root_tokens.row(i);
    }
    for (int b = 0; b < s.blocks; ++b) {
      AddBlock(s, a.blocks[b], h, normed, all_wide.topRows(rows));
    }
    Normalise(h, a.out_norm, normed);
    // The root's row among the joints' is computed for nothing, which costs less than to sort.
    Apply(a.joint_out, normed, all_turns.topRows(rows));
    for (int i = 0; i < samples; ++i) root_tokens.row(i) = normed.row(i * tokens + s.joints);
    Apply(a.root_out, root_tokens.topRows(samples), all_paths.topRows(samples));
    for (int i = 0; i < samples; ++i) {
      const auto turns = all_turns.middleRows(i * tokens, s.joints);
      for (int frame = 0; frame < s.future; ++frame) {
        Eigen::Map<Matrix>(out.row(frame).data(), s.joints, 3) = turns.middleCols(3 * frame, 3);
        out.row(frame).tail(6) = all_paths.row(i).segment(6 * frame, 6);
      }
      Eigen::Map<Matrix>(a.outputs + (first + i) * s.future * features, s.future, features)
          .noalias() = ConstMap(a.future_dct, s.future, s.future).transpose() * out;
    }
  }
}

}  // namespace poise::prediction::POISE_KERNEL_ISA
