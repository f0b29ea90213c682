#ifndef POISE_CORE_PREDICTION_GCN_GCN_KERNEL_H_
#define POISE_CORE_PREDICTION_GCN_GCN_KERNEL_H_

#include "core/prediction/network/layers.h"

/// GcnNet's forward pass on bare arrays, so that it can be built per instruction set.
namespace poise::prediction {

struct GcnArguments {
  int nodes, past, future, coefficients, width, blocks;
  const float* dct;          ///< (coefficients, past + future): the first rows of a whole one
  const GraphLayer* layers;  ///< 2 blocks + 2
  int batch;
  const float* inputs;  ///< (batch, past, nodes)
  float* outputs;       ///< (batch, future, nodes)
};

namespace isa_v2 {
void GcnKernel(const GcnArguments& arguments);
}
namespace isa_v3 {
void GcnKernel(const GcnArguments& arguments);
}
namespace isa_v4 {
void GcnKernel(const GcnArguments& arguments);
}

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_GCN_GCN_KERNEL_H_
