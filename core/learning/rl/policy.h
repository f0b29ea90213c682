#ifndef POISE_CORE_LEARNING_RL_POLICY_H_
#define POISE_CORE_LEARNING_RL_POLICY_H_

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/base/status.h"

namespace poise::rl {

/// What was learned, frozen: from an observation to the mean action. Needs no LibTorch to act.
/// Threads: one caller at a time; copies are cheap and share the weights.
class Policy {
 public:
  struct Network;  ///< normaliser and weights, constant

  explicit Policy(std::shared_ptr<const Network> network);
  Policy(const Policy& other);
  Policy& operator=(const Policy& other);
  Policy(Policy&&) noexcept;
  Policy& operator=(Policy&&) noexcept;
  ~Policy();

  int observation_size() const;
  int action_size() const;

  /// observation: (observation_size), raw; action: (action_size).
  void Act(std::span<const float> observation, std::span<float> action);

  /// observations: (batch, observation_size); actions: (batch, action_size).
  void Act(std::span<const float> observations, int batch, std::span<float> actions);

  /// The policy alone, without what training needs.
  std::string Save() const;

  /// Errors: kInvalidArgument MALFORMED_POLICY when the bytes are not those of Save.
  static StatusOr<Policy> Load(std::string_view bytes);

 private:
  struct Scratch;

  std::shared_ptr<const Network> network_;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace poise::rl

#endif  // POISE_CORE_LEARNING_RL_POLICY_H_
