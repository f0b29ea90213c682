#ifndef POISE_CORE_PREDICTION_MIXER_MIXER_KERNEL_H_
#define POISE_CORE_PREDICTION_MIXER_MIXER_KERNEL_H_

/// MixerNet's forward pass on bare arrays, so that it can be built per instruction set.
/// Matrices are row by row; a linear layer's weight is (outputs, inputs), as LibTorch has it.
namespace poise::prediction {

struct MixerLayer {
  const float* weight;
  const float* bias;
};

struct MixerBlock {
  MixerLayer joint_norm;  ///< scale and shift (width)
  const float* joints;    ///< (groups, tokens, tokens)
  MixerLayer within_norm;
  MixerLayer up;    ///< (hidden, width)
  MixerLayer down;  ///< (width, hidden)
};

struct MixerSizes {
  int past, future, joints, width, groups, hidden, blocks;
};

struct MixerArguments {
  MixerSizes sizes;
  const float* past_dct;    ///< (past, past)
  const float* future_dct;  ///< (future, future)
  MixerLayer joint_in;      ///< (width, 3 past + 6)
  MixerLayer root_in;       ///< (width, 6 past + 3)
  const float* names;       ///< (tokens, width): of the joints, then of the root
  const MixerBlock* blocks;
  MixerLayer out_norm;
  MixerLayer joint_out;  ///< (3 future, width)
  MixerLayer root_out;   ///< (6 future, width)
  int batch;
  const float* past;   ///< (batch, past, 3 joints + 6)
  const float* still;  ///< (batch, 6 joints + 3)
  float* future;       ///< (batch, future, 3 joints + 6)
};

namespace isa_v2 {
void MixerKernel(const MixerArguments& arguments);
}
namespace isa_v3 {
void MixerKernel(const MixerArguments& arguments);
}
namespace isa_v4 {
void MixerKernel(const MixerArguments& arguments);
}

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_MIXER_MIXER_KERNEL_H_
