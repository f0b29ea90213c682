#include "core/learning/rl/policy.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>

#include "core/base/tensor_file.h"

namespace poise::rl {
namespace {

using RowMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr const char* kMean = "observation.mean";
constexpr const char* kInverseDeviation = "observation.inverse_deviation";
constexpr const char* kLimit = "observation.limit";
constexpr const char* kActivation = "activation";

std::string WeightName(size_t layer) { return fmt::format("layers.{}.weight", layer); }
std::string BiasName(size_t layer) { return fmt::format("layers.{}.bias", layer); }

Status Malformed(std::string_view message) {
  return base::InvalidArgument("MALFORMED_POLICY", "", message);
}

// The shape of a tensor that the file must have with `rank` dimensions.
StatusOr<std::vector<int64_t>> ShapeOf(const base::TensorFile& file, const std::string& name,
                                       size_t rank) {
  POISE_ASSIGN_OR_RETURN(const base::TensorRecord* record, file.Find(name));
  if (record->shape.size() == rank) return record->shape;
  return Malformed(
      fmt::format("{} has {} dimensions, expected {}", name, record->shape.size(), rank));
}

StatusOr<LayerWeights> LoadLayer(const base::TensorFile& file, size_t layer) {
  const std::string name = WeightName(layer);
  POISE_ASSIGN_OR_RETURN(const std::vector<int64_t> shape, ShapeOf(file, name, 2));
  POISE_ASSIGN_OR_RETURN(const std::vector<float> weight, file.Floats(name, shape));
  const std::array<int64_t, 1> bias_shape = {shape[0]};
  POISE_ASSIGN_OR_RETURN(const std::vector<float> bias, file.Floats(BiasName(layer), bias_shape));
  return LayerWeights{
      .weight = Eigen::Map<const RowMatrix>(weight.data(), shape[0], shape[1]),
      .bias = Eigen::Map<const Eigen::VectorXf>(bias.data(), shape[0]),
  };
}

}  // namespace

StatusOr<std::shared_ptr<const PolicyNetwork>> PolicyNetwork::Create(
    ObservationScale scale, std::vector<LayerWeights> layers, Activation activation) {
  POISE_ASSIGN_OR_RETURN(FastMlp mlp, FastMlp::Create(layers, activation));
  if (static_cast<int>(scale.mean.size()) != mlp.input_size() ||
      scale.inverse_deviation.size() != scale.mean.size()) {
    return base::InvalidArgument(
        "LAYER_SIZE_MISMATCH", "",
        fmt::format("{} scales for {} inputs", scale.mean.size(), mlp.input_size()));
  }
  return std::make_shared<const PolicyNetwork>(
      PolicyNetwork{std::move(scale), std::move(layers), activation, std::move(mlp)});
}

void Policy::Act(std::span<const float> observations, int batch, std::span<float> actions) {
  scaled_.resize(observations.size());
  network_->scale.Apply(observations, scaled_);
  network_->mlp.Forward(scaled_, batch, actions, scratch_);
}

std::string Policy::Save() const {
  base::TensorFile file;
  const auto add = [&](const std::string& name, std::vector<int64_t> shape, const float* values) {
    int64_t count = 1;
    for (const int64_t size : shape) count *= size;
    file.tensors[name] =
        base::TensorRecord::FromFloats(std::move(shape), {values, static_cast<size_t>(count)});
  };
  const ObservationScale& scale = network_->scale;
  const auto inputs = static_cast<int64_t>(scale.mean.size());
  add(kMean, {inputs}, scale.mean.data());
  add(kInverseDeviation, {inputs}, scale.inverse_deviation.data());
  add(kLimit, {1}, &scale.limit);
  for (size_t i = 0; i < network_->layers.size(); ++i) {
    const LayerWeights& layer = network_->layers[i];
    const RowMatrix rows = layer.weight;
    add(WeightName(i), {rows.rows(), rows.cols()}, rows.data());
    add(BiasName(i), {layer.bias.size()}, layer.bias.data());
  }
  file.metadata[kActivation] = network_->activation == Activation::kTanh ? "tanh" : "relu";
  return base::EncodeTensors(file);
}

StatusOr<Policy> Policy::Load(std::string_view bytes) {
  POISE_ASSIGN_OR_RETURN(const base::TensorFile file, base::DecodeTensors(bytes, "policy"));
  const auto activation = file.metadata.find(kActivation);
  if (activation == file.metadata.end() ||
      (activation->second != "tanh" && activation->second != "relu")) {
    return Malformed("the activation is neither tanh nor relu");
  }
  ObservationScale scale;
  POISE_ASSIGN_OR_RETURN(const std::vector<int64_t> shape, ShapeOf(file, kMean, 1));
  POISE_ASSIGN_OR_RETURN(scale.mean, file.Floats(kMean, shape));
  POISE_ASSIGN_OR_RETURN(scale.inverse_deviation, file.Floats(kInverseDeviation, shape));
  const std::array<int64_t, 1> one = {1};
  POISE_ASSIGN_OR_RETURN(const std::vector<float> limit, file.Floats(kLimit, one));
  scale.limit = limit.front();
  std::vector<LayerWeights> layers;
  while (file.tensors.contains(WeightName(layers.size()))) {
    POISE_ASSIGN_OR_RETURN(LayerWeights layer, LoadLayer(file, layers.size()));
    layers.push_back(std::move(layer));
  }
  POISE_ASSIGN_OR_RETURN(
      auto network,
      PolicyNetwork::Create(std::move(scale), std::move(layers),
                            activation->second == "tanh" ? Activation::kTanh : Activation::kRelu));
  return Policy(std::move(network));
}

}  // namespace poise::rl
