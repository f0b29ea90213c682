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
  MixerLayer time_norm;  ///< scale and shift (width)
  MixerLayer time;       ///< (past, past)
  MixerLayer pose_norm;
  MixerLayer up;    ///< (hidden, width)
  MixerLayer down;  ///< (width, hidden)
};

struct MixerSizes {
  int past, future, features, still, width, hidden, blocks;
};

struct MixerArguments {
  MixerSizes sizes;
  const float* past_dct;    ///< (past, past)
  const float* future_dct;  ///< (future, future)
  MixerLayer past_in;       ///< (width, features)
  MixerLayer still_in;      ///< (width, still)
  const MixerBlock* blocks;
  MixerLayer out_norm;
  MixerLayer time_out;  ///< (future, past)
  MixerLayer pose_out;  ///< (features, width)
  int batch;
  const float* past;   ///< (batch, past, features)
  const float* still;  ///< (batch, still)
  float* future;       ///< (batch, future, features)
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
