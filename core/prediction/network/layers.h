#ifndef POISE_CORE_PREDICTION_NETWORK_LAYERS_H_
#define POISE_CORE_PREDICTION_NETWORK_LAYERS_H_

/// Layers' numbers as bare arrays, for forward passes that are built per instruction set
/// (layer_kernels.h). Matrices are row by row.
namespace poise::prediction {

/// Of a linear layer: weight (outputs, inputs), as LibTorch has it; bias (outputs), null for none.
/// Of a layer norm: scale and shift (features).
struct LayerWeights {
  const float* weight;
  const float* bias;
};

/// out = graph * (in * weight) + bias, then, where there is a scale, tanh(scale * out + shift).
struct GraphLayer {
  int inputs, outputs;
  const float* graph;   ///< (nodes, nodes)
  const float* weight;  ///< (inputs, outputs)
  const float* bias;    ///< (outputs); null: none
  const float* scale;   ///< (nodes, outputs): the batch norm; null: none, and no tanh
  const float* shift;   ///< (nodes, outputs)
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_NETWORK_LAYERS_H_
