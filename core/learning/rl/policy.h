#ifndef POISE_CORE_LEARNING_RL_POLICY_H_
#define POISE_CORE_LEARNING_RL_POLICY_H_

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/status.h"
#include "core/learning/rl/fast_mlp.h"
#include "core/learning/rl/running_moments.h"

namespace poise::rl {

/// What a policy computes with: observations are scaled, then go through the layers. Constant.
struct PolicyNetwork {
  ObservationScale scale;
  std::vector<LayerWeights> layers;
  Activation activation;
  FastMlp mlp;  ///< of the same layers

  /// Errors: those of FastMlp::Create; kInvalidArgument LAYER_SIZE_MISMATCH when the scale has
  /// another size than the first layer's input.
  static StatusOr<std::shared_ptr<const PolicyNetwork>> Create(ObservationScale scale,
                                                               std::vector<LayerWeights> layers,
                                                               Activation activation);
};

/// What was learned, frozen: from an observation to the mean action. Needs no LibTorch to act.
/// Threads: one caller at a time; copies are cheap and share the weights.
class Policy {
 public:
  explicit Policy(std::shared_ptr<const PolicyNetwork> network) : network_(std::move(network)) {}
  Policy(const Policy& other) : network_(other.network_) {}
  Policy& operator=(const Policy& other) {
    network_ = other.network_;
    return *this;
  }
  Policy(Policy&&) noexcept = default;
  Policy& operator=(Policy&&) noexcept = default;

  int observation_size() const { return network_->mlp.input_size(); }
  int action_size() const { return network_->mlp.output_size(); }

  /// observation: (observation_size), raw; action: (action_size).
  void Act(std::span<const float> observation, std::span<float> action) {
    Act(observation, 1, action);
  }

  /// observations: (batch, observation_size); actions: (batch, action_size).
  void Act(std::span<const float> observations, int batch, std::span<float> actions);

  /// The policy alone, without what training needs: a safetensors file.
  std::string Save() const;

  /// Errors: kInvalidArgument MALFORMED_TENSORS, MISSING_TENSOR, WRONG_SHAPE, MALFORMED_POLICY
  /// when the bytes are not those of Save.
  static StatusOr<Policy> Load(std::string_view bytes);

 private:
  std::shared_ptr<const PolicyNetwork> network_;
  FastMlp::Scratch scratch_;   // not shared by copies
  std::vector<float> scaled_;  // (batch, observation_size)
};

}  // namespace poise::rl

#endif  // POISE_CORE_LEARNING_RL_POLICY_H_
