#ifndef POISE_CORE_PREDICTION_RNN_RNN_KERNEL_H_
#define POISE_CORE_PREDICTION_RNN_RNN_KERNEL_H_

#include "core/prediction/network/layers.h"

/// RnnNet's forward pass on bare arrays, so that it can be built per instruction set.
namespace poise::prediction {

struct RnnArguments {
  int columns, past, future, hidden;
  LayerWeights input;   ///< (3 hidden, columns) of the gates reset, update and new
  LayerWeights state;   ///< (3 hidden, hidden)
  LayerWeights change;  ///< (columns, hidden)
  int batch;
  const float* inputs;  ///< (batch, past, columns)
  float* outputs;       ///< (batch, future, columns)
};

namespace isa_v2 {
void RnnKernel(const RnnArguments& arguments);
}
namespace isa_v3 {
void RnnKernel(const RnnArguments& arguments);
}
namespace isa_v4 {
void RnnKernel(const RnnArguments& arguments);
}

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_RNN_RNN_KERNEL_H_
