#ifndef POISE_CORE_PREDICTION_GCN_GCN_KERNEL_H_
#define POISE_CORE_PREDICTION_GCN_GCN_KERNEL_H_

/// GcnNet's forward pass on bare arrays, so that it can be built per instruction set. Matrices are
/// row by row.
namespace poise::prediction {

/// out = graph * (in * weight) + bias, then, but for the last layer, tanh(scale * out + shift).
struct GcnLayer {
  const float* graph;   ///< (nodes, nodes)
  const float* weight;  ///< (inputs, outputs)
  const float* bias;    ///< (outputs)
  const float* scale;   ///< (nodes, outputs): the batch norm
  const float* shift;   ///< (nodes, outputs)
};

struct GcnArguments {
  int nodes, frames, width, blocks;
  const float* dct;        ///< (frames, frames), orthonormal
  const GcnLayer* layers;  ///< 2 blocks + 2
  int batch;
  const float* motion;  ///< (batch, frames, nodes): the past, then its last frame again and again
  float* predicted;     ///< the same shape: past and future
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
