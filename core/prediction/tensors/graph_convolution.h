#ifndef POISE_CORE_PREDICTION_TENSORS_GRAPH_CONVOLUTION_H_
#define POISE_CORE_PREDICTION_TENSORS_GRAPH_CONVOLUTION_H_

#include <torch/torch.h>

namespace poise::prediction {

struct GraphConvolutionOptions {
  int64_t nodes = 0, inputs = 0, outputs = 0;
  bool biased = true;
  bool bent = true;    ///< followed by a batch norm (over nodes x outputs), tanh and dropout
  double dropout = 0;  ///< [0 to 1)
};

/// graph * (x * weight) + bias with a free matrix between nodes, as LTD and POTR have it; served by
/// NetworkWeights::TakeGraph. Shapes: (batch, nodes, inputs) to (batch, nodes, outputs)
/// Source: reference sec. 4.2, step 2.
class GraphConvolution : public torch::nn::Module {
 public:
  explicit GraphConvolution(const GraphConvolutionOptions& options);
  torch::Tensor forward(const torch::Tensor& x);

 private:
  const GraphConvolutionOptions options_;
  torch::Tensor graph_, weight_, bias_;
  torch::nn::BatchNorm1d norm_ = nullptr;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_TENSORS_GRAPH_CONVOLUTION_H_
