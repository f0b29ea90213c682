#ifndef POISE_CORE_PREDICTION_MIXER_MIXER_KERNEL_H_
#define POISE_CORE_PREDICTION_MIXER_MIXER_KERNEL_H_

#include "core/prediction/network/layers.h"

/// MixerNet's forward pass on bare arrays, so that it can be built per instruction set.
namespace poise::prediction {

struct MixerBlock {
  LayerWeights joint_norm;  ///< scale and shift (width)
  const float* joints;      ///< (groups, tokens, tokens)
  LayerWeights within_norm;
  LayerWeights up;    ///< (hidden, width)
  LayerWeights down;  ///< (width, hidden)
};

struct MixerSizes {
  int past, future, joints, width, groups, hidden, blocks;
};

struct MixerArguments {
  MixerSizes sizes;
  const float* past_dct;    ///< (past, past)
  const float* future_dct;  ///< (future, future)
  LayerWeights joint_in;    ///< (width, 3 past + 6)
  LayerWeights root_in;     ///< (width, 6 past + 3)
  const float* names;       ///< (tokens, width): of the joints, then of the root
  const MixerBlock* blocks;
  LayerWeights out_norm;
  LayerWeights joint_out;  ///< (3 future, width)
  LayerWeights root_out;   ///< (6 future, width)
  int batch;
  const float*
      inputs;      ///< per sample the past (past, 3 joints + 6), then its last pose (6 joints + 3)
  float* outputs;  ///< (batch, future, 3 joints + 6)
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
