#include "core/prediction/tensors/graph_convolution.h"

#include <cmath>

#include "core/prediction/tensors/dropout.h"

namespace poise::prediction {

using torch::Tensor;

GraphConvolution::GraphConvolution(const GraphConvolutionOptions& options) : options_(options) {
  const double most = 1 / std::sqrt(static_cast<double>(options.outputs));
  const auto uniform = [&](const char* name, std::vector<int64_t> shape) {
    return register_parameter(name, torch::empty(shape).uniform_(-most, most));
  };
  graph_ = uniform("graph", {options.nodes, options.nodes});
  weight_ = uniform("weight", {options.inputs, options.outputs});
  if (options.biased) bias_ = uniform("bias", {options.outputs});
  if (!options.bent) return;
  norm_ = register_module("norm", torch::nn::BatchNorm1d(options.nodes * options.outputs));
}

Tensor GraphConvolution::forward(const Tensor& x) {
  Tensor y = torch::matmul(graph_, torch::matmul(x, weight_));
  if (bias_.defined()) y = y + bias_;
  if (!options_.bent) return y;
  return Dropout(norm_(y.flatten(1)).view_as(y).tanh(), options_.dropout, is_training());
}

}  // namespace poise::prediction
