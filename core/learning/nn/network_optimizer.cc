#include "core/learning/nn/network_optimizer.h"

#include <cmath>
#include <sstream>
#include <tuple>
#include <utility>
#include <vector>

#include "core/learning/nn/module_state.h"

namespace poise::learning {
namespace {

// So that a clipped gradient is never longer than asked for, as PyTorch does it.
constexpr double kNormEpsilon = 1e-6;

std::unique_ptr<torch::optim::Optimizer> MakeOptimizer(std::vector<torch::Tensor> parameters,
                                                       const OptimizerConfig& config) {
  namespace optim = torch::optim;
  if (config.type == "sgd") {
    return std::make_unique<optim::SGD>(std::move(parameters),
                                        optim::SGDOptions(config.learning_rate)
                                            .momentum(config.momentum)
                                            .weight_decay(config.weight_decay));
  }
  const auto betas = std::make_tuple(config.beta1, config.beta2);
  if (config.type == "adam") {
    return std::make_unique<optim::Adam>(std::move(parameters),
                                         optim::AdamOptions(config.learning_rate)
                                             .betas(betas)
                                             .eps(config.epsilon)
                                             .weight_decay(config.weight_decay));
  }
  return std::make_unique<optim::AdamW>(std::move(parameters),
                                        optim::AdamWOptions(config.learning_rate)
                                            .betas(betas)
                                            .eps(config.epsilon)
                                            .weight_decay(config.weight_decay));
}

double GradientNorm(const std::vector<torch::Tensor>& parameters) {
  double sum = 0;
  for (const torch::Tensor& parameter : parameters) {
    if (!parameter.grad().defined()) continue;
    const double norm = parameter.grad().norm().item<double>();
    sum += norm * norm;
  }
  return std::sqrt(sum);
}

}  // namespace

NetworkOptimizer::NetworkOptimizer(torch::nn::Module& module, const OptimizerConfig& config)
    : module_(&module),
      clip_norm_(config.clip_norm),
      optimizer_(MakeOptimizer(module.parameters(), config)) {}

StatusOr<double> NetworkOptimizer::Step(double rate) {
  const double norm = GradientNorm(optimizer_->param_groups()[0].params());
  if (!std::isfinite(norm)) {
    POISE_RETURN_IF_ERROR(CheckGradientsFinite(*module_, "training"));
    return base::MakeError(absl::StatusCode::kOutOfRange, "NOT_FINITE", "",
                           "training: the gradient is too large for a float");
  }
  if (clip_norm_ > 0 && norm > clip_norm_) {
    const torch::NoGradGuard no_gradient;
    for (torch::Tensor& parameter : optimizer_->param_groups()[0].params()) {
      if (parameter.grad().defined())
        parameter.mutable_grad().mul_(clip_norm_ / (norm + kNormEpsilon));
    }
  }
  for (auto& group : optimizer_->param_groups()) group.options().set_lr(rate);
  optimizer_->step();
  return norm;
}

std::string NetworkOptimizer::Save() const {
  std::ostringstream stream;
  torch::save(*optimizer_, stream);
  return std::move(stream).str();
}

void NetworkOptimizer::Load(const std::string& bytes) {
  std::istringstream stream(bytes);
  torch::load(*optimizer_, stream);
}

}  // namespace poise::learning
