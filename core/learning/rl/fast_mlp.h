#ifndef POISE_CORE_LEARNING_RL_FAST_MLP_H_
#define POISE_CORE_LEARNING_RL_FAST_MLP_H_

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "core/base/isa.h"
#include "core/base/status.h"
#include "core/learning/rl/kernel/layer_kernel.h"

namespace poise::rl {

struct LayerWeights {
  Eigen::MatrixXf weight;  // (out, in)
  Eigen::VectorXf bias;    // (out)
};

enum class Activation { kRelu, kTanh };

/// Single precision numbers at an address that vectors can be loaded from.
struct FreeAligned {
  void operator()(float* numbers) const;
};
using AlignedFloats = std::unique_ptr<float[], FreeAligned>;

/// Feed-forward network for rollouts: hidden layers with one activation, linear output. Own memory
/// layout and kernels per instruction set; batches from 1 up. Copies share the weights.
/// A sample's output does not depend on the batch that it stands in, to the bit.
/// Threads: constant; a Scratch belongs to one thread.
class FastMlp {
 public:
  struct Scratch {
    AlignedFloats buffers[2];
    size_t size = 0;  ///< of each
  };

  /// Errors: kInvalidArgument NO_LAYERS, LAYER_SIZE_MISMATCH (empty, a bias of another size than
  /// the outputs, inputs that are not the layer's before), WEIGHT_NOT_FINITE.
  /// `isa` is for comparisons: at most base::BestIsa().
  static StatusOr<FastMlp> Create(const std::vector<LayerWeights>& layers, Activation activation,
                                  base::Isa isa = base::BestIsa());

  int input_size() const { return layers_.front().num_inputs; }
  int output_size() const { return output_size_; }

  /// Shapes: input (batch, input_size), output (batch, output_size), both row by row. Allocates
  /// only where `scratch` has not met as large a batch before.
  void Forward(std::span<const float> input, int batch, std::span<float> output,
               Scratch& scratch) const;

 private:
  FastMlp() = default;

  void (*kernel_)(const LayerArguments&) = nullptr;
  std::vector<LayerArguments> layers_;     // without batch, input and output
  std::shared_ptr<const float[]> memory_;  // what their weights and biases point into
  int output_size_ = 0;
  int widest_ = 0;  // largest number of a layer's outputs, with padding
};

}  // namespace poise::rl

#endif  // POISE_CORE_LEARNING_RL_FAST_MLP_H_
