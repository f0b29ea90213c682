#ifndef POISE_CORE_LEARNING_RL_TRAINABLE_MLP_H_
#define POISE_CORE_LEARNING_RL_TRAINABLE_MLP_H_

#include <ATen/core/Tensor.h>

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/base/status.h"
#include "core/base/tensor_file.h"
#include "core/learning/rl/fast_mlp.h"
#include "core/learning/rl/ppo_config.h"

namespace poise::rl {

/// The network of FastMlp with gradients and an optimiser. All parameters lie in one tensor, so
/// that a step of the optimiser is a few operations whatever the number of layers, and the gradient
/// is written by hand. `tail` more parameters ride along for the caller.
/// Threads: one caller at a time.
class TrainableMlp {
 public:
  struct Layer {
    at::Tensor weight;  // (out, in)
    at::Tensor bias;    // (out)
  };

  /// `sizes`: of the input, the hidden layers and the output. Everything starts as 0.
  TrainableMlp(const std::vector<int>& sizes, Activation activation, int tail = 0,
               at::ScalarType type = at::kFloat);

  /// Hidden weights as Glorot and Bengio 2010, uniform; last ones as NetworkConfig::output_scale.
  void Initialize(base::Random& random, double output_scale);

  /// inputs: (batch, in). Returns (batch, out).
  at::Tensor Evaluate(const at::Tensor& inputs) const;
  /// The same, and keeps what Backward needs.
  at::Tensor Forward(const at::Tensor& inputs);
  /// output_gradient: (batch, out), of a loss of the last Forward's result. Sets gradient(), but
  /// for its tail, which becomes 0.
  void Backward(const at::Tensor& output_gradient);

  /// One step down gradient(), which is first cut to `gradient_norm` (0 = not). Returns its norm.
  double Step(const NetworkConfig& config, double learning_rate, double gradient_norm);

  const std::vector<Layer>& layers() const { return layers_; }
  const at::Tensor& parameters() const { return parameters_; }  // (all)
  const at::Tensor& gradient() const { return gradient_; }      // (all)
  at::Tensor tail() const;                                      // (tail)
  at::Tensor gradient_tail() const;                             // (tail)

  /// For FastMlp.
  std::vector<LayerWeights> Weights() const;

  /// A copy that shares nothing.
  TrainableMlp Clone() const;

  /// Errors: kOutOfRange NOT_FINITE naming the tensor below `name` ("actor.layers.0.weight").
  Status CheckFinite(const std::string& name) const;

  /// Parameters and the optimiser's state, as `name`.parameters and so on.
  void Save(const std::string& name, base::TensorFile& file) const;
  /// Errors: kInvalidArgument MISSING_TENSOR, WRONG_SHAPE. Some may be set then.
  Status Restore(const std::string& name, const base::TensorFile& file);

 private:
  std::vector<Layer> LayersOf(const at::Tensor& all) const;
  void StepAdam(double learning_rate);

  std::vector<int> sizes_;
  Activation activation_;
  int tail_;
  at::Tensor parameters_;                // (all) layer by layer, weight then bias; then the tail
  at::Tensor gradient_;                  // (all)
  at::Tensor decays_;                    // (all) 1 for weights, 0 for biases and the tail
  at::Tensor first_moment_;              // (all) momentum for sgd
  at::Tensor second_moment_;             // (all)
  int64_t steps_ = 0;                    // of the optimiser
  std::vector<Layer> layers_;            // views of parameters_
  std::vector<Layer> gradient_layers_;   // views of gradient_
  std::vector<at::Tensor> activations_;  // of the last Forward: the input of each layer
};

}  // namespace poise::rl

#endif  // POISE_CORE_LEARNING_RL_TRAINABLE_MLP_H_
