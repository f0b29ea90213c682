#ifndef POISE_CORE_PREDICTION_POTR_POTR_KERNEL_H_
#define POISE_CORE_PREDICTION_POTR_POTR_KERNEL_H_

#include "core/prediction/network/layers.h"

/// PotrNet's forward pass on bare arrays, so that it can be built per instruction set.
namespace poise::prediction {

struct AttentionWeights {
  LayerWeights in;   ///< (3 width, width): of query, key and value
  LayerWeights out;  ///< (width, width)
};

struct PotrEncoderLayer {
  LayerWeights norm1;
  AttentionWeights attention;
  LayerWeights norm2;
  LayerWeights up;    ///< (hidden, width)
  LayerWeights down;  ///< (width, hidden)
};

struct PotrDecoderLayer {
  LayerWeights norm1;
  AttentionWeights self;
  LayerWeights norm2;
  AttentionWeights cross;
  LayerWeights norm3;
  LayerWeights up, down;
};

struct PotrSizes {
  int columns, past, future, node_width, joint_width, width, heads, layers, hidden;
};

struct PotrArguments {
  PotrSizes sizes;
  GraphLayer graphs[4];
  LayerWeights frame;  ///< (width, nodes * joint_width)
  LayerWeights pose;   ///< (columns, width)
  const PotrEncoderLayer* encoder;
  const PotrDecoderLayer* decoder;
  bool residual;
  const float* positions;  ///< (frames, width): of as many as past and future have
  int batch;
  const float* inputs;  ///< (batch, past, columns)
  float* outputs;       ///< (batch, future, columns)
};

namespace isa_v2 {
void PotrKernel(const PotrArguments& arguments);
}
namespace isa_v3 {
void PotrKernel(const PotrArguments& arguments);
}
namespace isa_v4 {
void PotrKernel(const PotrArguments& arguments);
}

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_POTR_POTR_KERNEL_H_
