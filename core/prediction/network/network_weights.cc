#include "core/prediction/network/network_weights.h"

#include <cmath>
#include <utility>

namespace poise::prediction {
namespace {

constexpr float kNormEpsilon = 1e-5f;  // as LibTorch's BatchNorm1d

}  // namespace

const float* NetworkWeights::Keep(std::vector<float> numbers) {
  return numbers_.emplace_back(std::move(numbers)).data();
}

StatusOr<const float*> NetworkWeights::Take(const base::TensorFile& file, const std::string& name,
                                            std::vector<int64_t> shape) {
  POISE_ASSIGN_OR_RETURN(std::vector<float> numbers, file.Floats(name, shape));
  return Keep(std::move(numbers));
}

StatusOr<LayerWeights> NetworkWeights::TakeLinear(const base::TensorFile& file,
                                                  const std::string& name, int64_t outputs,
                                                  int64_t inputs, bool biased) {
  LayerWeights layer{};
  POISE_ASSIGN_OR_RETURN(layer.weight, Take(file, name + ".weight", {outputs, inputs}));
  if (!biased) return layer;
  POISE_ASSIGN_OR_RETURN(layer.bias, Take(file, name + ".bias", {outputs}));
  return layer;
}

StatusOr<LayerWeights> NetworkWeights::TakeNorm(const base::TensorFile& file,
                                                const std::string& name, int64_t features) {
  LayerWeights layer{};
  POISE_ASSIGN_OR_RETURN(layer.weight, Take(file, name + ".weight", {features}));
  POISE_ASSIGN_OR_RETURN(layer.bias, Take(file, name + ".bias", {features}));
  return layer;
}

StatusOr<GraphLayer> NetworkWeights::TakeGraph(const base::TensorFile& file,
                                               const std::string& name, const GraphShape& shape) {
  GraphLayer layer{.inputs = shape.inputs,
                   .outputs = shape.outputs,
                   .graph = nullptr,
                   .weight = nullptr,
                   .bias = nullptr,
                   .scale = nullptr,
                   .shift = nullptr};
  POISE_ASSIGN_OR_RETURN(layer.graph, Take(file, name + ".graph", {shape.nodes, shape.nodes}));
  POISE_ASSIGN_OR_RETURN(layer.weight, Take(file, name + ".weight", {shape.inputs, shape.outputs}));
  if (shape.biased) {
    POISE_ASSIGN_OR_RETURN(layer.bias, Take(file, name + ".bias", {shape.outputs}));
  }
  if (!shape.normed) return layer;
  const std::vector<int64_t> all = {int64_t{shape.nodes} * shape.outputs};
  POISE_ASSIGN_OR_RETURN(std::vector<float> scale, file.Floats(name + ".norm.weight", all));
  POISE_ASSIGN_OR_RETURN(std::vector<float> shift, file.Floats(name + ".norm.bias", all));
  POISE_ASSIGN_OR_RETURN(const std::vector<float> mean,
                         file.Floats(name + ".norm.running_mean", all));
  POISE_ASSIGN_OR_RETURN(const std::vector<float> variance,
                         file.Floats(name + ".norm.running_var", all));
  for (size_t i = 0; i < scale.size(); ++i) {
    scale[i] /= std::sqrt(variance[i] + kNormEpsilon);
    shift[i] -= mean[i] * scale[i];
  }
  layer.scale = Keep(std::move(scale));
  layer.shift = Keep(std::move(shift));
  return layer;
}

}  // namespace poise::prediction
