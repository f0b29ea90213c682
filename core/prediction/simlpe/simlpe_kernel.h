#ifndef POISE_CORE_PREDICTION_SIMLPE_SIMLPE_KERNEL_H_
#define POISE_CORE_PREDICTION_SIMLPE_SIMLPE_KERNEL_H_

#include "core/prediction/network/layers.h"

/// SimlpeNet's forward pass on bare arrays, so that it can be built per instruction set.
namespace poise::prediction {

struct SimlpeBlock {
  LayerWeights along_time;  ///< (past, past)
  LayerWeights norm;        ///< (columns)
};

struct SimlpeArguments {
  int columns, past, future, blocks;
  const float* dct;  ///< (past, past)
  LayerWeights in;   ///< (columns, columns)
  const SimlpeBlock* layers;
  LayerWeights out;  ///< (columns, columns)
  int batch;
  const float* inputs;  ///< (batch, past, columns)
  float* outputs;       ///< (batch, future, columns)
};

namespace isa_v2 {
void SimlpeKernel(const SimlpeArguments& arguments);
}
namespace isa_v3 {
void SimlpeKernel(const SimlpeArguments& arguments);
}
namespace isa_v4 {
void SimlpeKernel(const SimlpeArguments& arguments);
}

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_SIMLPE_SIMLPE_KERNEL_H_
