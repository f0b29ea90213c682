#ifndef POISE_CORE_LEARNING_NN_NETWORK_OPTIMIZER_H_
#define POISE_CORE_LEARNING_NN_NETWORK_OPTIMIZER_H_

#include <torch/torch.h>

#include <memory>
#include <string>

#include "core/base/status.h"
#include "core/learning/nn/trainer_config.h"

namespace poise::learning {

/// Makes one module's weights follow their gradient. The module must outlive it.
class NetworkOptimizer {
 public:
  NetworkOptimizer(torch::nn::Module& module, const OptimizerConfig& config);

  void ClearGradients() { optimizer_->zero_grad(); }
  /// Applies the gradients at this rate, shortened to config.clip_norm. Returns their norm before.
  /// Errors: kOutOfRange NOT_FINITE naming the gradient, and then nothing has changed.
  StatusOr<double> Step(double rate);

  /// Moments and step counts, as bytes for Load on an optimiser of the same module and config.
  std::string Save() const;
  void Load(const std::string& bytes);

 private:
  torch::nn::Module* module_;
  double clip_norm_;
  std::unique_ptr<torch::optim::Optimizer> optimizer_;
};

}  // namespace poise::learning

#endif  // POISE_CORE_LEARNING_NN_NETWORK_OPTIMIZER_H_
