#include "core/learning/rl/trainable_mlp.h"

#include <ATen/ATen.h>
#include <fmt/format.h>

#include <cmath>

#include "core/learning/rl/tensor_record.h"

namespace poise::rl {
namespace {

using RowMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void FillUniform(const at::Tensor& tensor, double limit, base::Random& random) {
  std::vector<double> values(tensor.numel());
  for (double& value : values) value = random.Uniform(-limit, limit);
  tensor.copy_(at::from_blob(values.data(), tensor.sizes(), at::kDouble));
}

bool AllFinite(const at::Tensor& tensor) { return at::isfinite(tensor).all().item<bool>(); }

}  // namespace

TrainableMlp::TrainableMlp(const std::vector<int>& sizes, Activation activation, int tail,
                           at::ScalarType type)
    : sizes_(sizes), activation_(activation), tail_(tail) {
  int64_t all = tail;
  for (size_t i = 0; i + 1 < sizes.size(); ++i) {
    all += static_cast<int64_t>(sizes[i] + 1) * sizes[i + 1];
  }
  for (at::Tensor* tensor : {&parameters_, &gradient_, &decays_, &first_moment_, &second_moment_}) {
    *tensor = at::zeros({all}, type);
  }
  layers_ = LayersOf(parameters_);
  gradient_layers_ = LayersOf(gradient_);
  for (const Layer& layer : LayersOf(decays_)) layer.weight.fill_(1);
}

std::vector<TrainableMlp::Layer> TrainableMlp::LayersOf(const at::Tensor& all) const {
  std::vector<Layer> layers;
  int64_t begin = 0;
  for (size_t i = 0; i + 1 < sizes_.size(); ++i) {
    const int64_t in = sizes_[i], out = sizes_[i + 1];
    layers.push_back(
        {all.narrow(0, begin, in * out).view({out, in}), all.narrow(0, begin + in * out, out)});
    begin += (in + 1) * out;
  }
  return layers;
}

at::Tensor TrainableMlp::tail() const {
  return parameters_.narrow(0, parameters_.numel() - tail_, tail_);
}

at::Tensor TrainableMlp::gradient_tail() const {
  return gradient_.narrow(0, gradient_.numel() - tail_, tail_);
}

void TrainableMlp::Initialize(base::Random& random, double output_scale) {
  parameters_.zero_();
  for (size_t i = 0; i < layers_.size(); ++i) {
    const double in = sizes_[i], out = sizes_[i + 1];
    const bool last = i + 1 == layers_.size();
    FillUniform(layers_[i].weight, last ? output_scale / std::sqrt(in) : std::sqrt(6 / (in + out)),
                random);
  }
}

at::Tensor TrainableMlp::Evaluate(const at::Tensor& inputs) const {
  at::Tensor values = inputs;
  for (size_t i = 0; i < layers_.size(); ++i) {
    values = at::addmm(layers_[i].bias, values, layers_[i].weight.t());
    if (i + 1 == layers_.size()) break;
    if (activation_ == Activation::kTanh) {
      values.tanh_();
    } else {
      values.relu_();
    }
  }
  return values;
}

at::Tensor TrainableMlp::Forward(const at::Tensor& inputs) {
  activations_ = {inputs};
  for (size_t i = 0; i < layers_.size(); ++i) {
    at::Tensor values = at::addmm(layers_[i].bias, activations_[i], layers_[i].weight.t());
    if (i + 1 == layers_.size()) return values;
    activations_.push_back(activation_ == Activation::kTanh ? values.tanh_() : values.relu_());
  }
  return inputs;
}

void TrainableMlp::Backward(const at::Tensor& output_gradient) {
  gradient_tail().zero_();
  at::Tensor gradient = output_gradient;
  for (size_t i = layers_.size(); i-- > 0;) {
    at::mm_out(gradient_layers_[i].weight, gradient.t(), activations_[i]);
    at::sum_out(gradient_layers_[i].bias, gradient, 0);
    if (i == 0) break;
    gradient = at::mm(gradient, layers_[i].weight);
    gradient = activation_ == Activation::kTanh
                   ? at::tanh_backward(gradient, activations_[i])
                   : at::threshold_backward(gradient, activations_[i], 0);
  }
}

double TrainableMlp::Step(const NetworkConfig& config, double learning_rate, double gradient_norm) {
  const double norm = gradient_.norm().item<double>();
  if (gradient_norm > 0 && norm > gradient_norm) gradient_.mul_(gradient_norm / norm);
  if (config.weight_decay > 0) {
    gradient_.add_(parameters_ * decays_, config.weight_decay);
  }
  ++steps_;
  if (config.optimizer == "adam") {
    StepAdam(learning_rate);
  } else {
    first_moment_.mul_(config.momentum).add_(gradient_);
    parameters_.add_(first_moment_, -learning_rate);
  }
  return norm;
}

// Kingma and Ba 2015, algorithm 1.
void TrainableMlp::StepAdam(double learning_rate) {
  constexpr double kBeta1 = 0.9, kBeta2 = 0.999, kEpsilon = 1e-8;
  first_moment_.mul_(kBeta1).add_(gradient_, 1 - kBeta1);
  second_moment_.mul_(kBeta2).addcmul_(gradient_, gradient_, 1 - kBeta2);
  const double unbias1 = 1 - std::pow(kBeta1, static_cast<double>(steps_));
  const double unbias2 = 1 - std::pow(kBeta2, static_cast<double>(steps_));
  const at::Tensor root = second_moment_.sqrt().div_(std::sqrt(unbias2)).add_(kEpsilon);
  parameters_.addcdiv_(first_moment_, root, -learning_rate / unbias1);
}

std::vector<LayerWeights> TrainableMlp::Weights() const {
  std::vector<LayerWeights> weights;
  for (const Layer& layer : layers_) {
    const at::Tensor weight = layer.weight.to(at::kFloat), bias = layer.bias.to(at::kFloat);
    weights.push_back(
        {Eigen::Map<const RowMatrix>(weight.data_ptr<float>(), weight.size(0), weight.size(1)),
         Eigen::Map<const Eigen::VectorXf>(bias.data_ptr<float>(), bias.size(0))});
  }
  return weights;
}

TrainableMlp TrainableMlp::Clone() const {
  TrainableMlp clone(sizes_, activation_, tail_, parameters_.scalar_type());
  clone.parameters_.copy_(parameters_);
  clone.first_moment_.copy_(first_moment_);
  clone.second_moment_.copy_(second_moment_);
  clone.steps_ = steps_;
  return clone;
}

Status TrainableMlp::CheckFinite(const std::string& name) const {
  if (AllFinite(parameters_)) return absl::OkStatus();
  std::string tensor = name + ".log_deviations";
  for (size_t i = layers_.size(); i-- > 0;) {
    if (!AllFinite(layers_[i].bias)) tensor = fmt::format("{}.layers.{}.bias", name, i);
    if (!AllFinite(layers_[i].weight)) tensor = fmt::format("{}.layers.{}.weight", name, i);
  }
  return base::MakeError(absl::StatusCode::kOutOfRange, "NOT_FINITE", "",
                         fmt::format("{} is not finite after an update", tensor));
}

void TrainableMlp::Save(const std::string& name, base::TensorFile& file) const {
  file.tensors[name + ".parameters"] = ToRecord(parameters_);
  file.tensors[name + ".first_moment"] = ToRecord(first_moment_);
  file.tensors[name + ".second_moment"] = ToRecord(second_moment_);
  file.tensors[name + ".steps"] = ToRecord(at::full({1}, steps_, at::kLong));
}

Status TrainableMlp::Restore(const std::string& name, const base::TensorFile& file) {
  POISE_RETURN_IF_ERROR(CopyRecord(file, name + ".parameters", parameters_));
  POISE_RETURN_IF_ERROR(CopyRecord(file, name + ".first_moment", first_moment_));
  POISE_RETURN_IF_ERROR(CopyRecord(file, name + ".second_moment", second_moment_));
  const at::Tensor steps = at::zeros({1}, at::kLong);
  POISE_RETURN_IF_ERROR(CopyRecord(file, name + ".steps", steps));
  steps_ = steps.item<int64_t>();
  return CheckFinite(name);
}

}  // namespace poise::rl
