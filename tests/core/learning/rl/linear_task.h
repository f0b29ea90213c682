#ifndef POISE_TESTS_CORE_LEARNING_RL_LINEAR_TASK_H_
#define POISE_TESTS_CORE_LEARNING_RL_LINEAR_TASK_H_

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/learning/rl/environment.h"

namespace poise::rl {

/// Two carts, each pushed by its own action: positions and velocities shall come
/// to rest at 0 for little force. A linear-quadratic regulator, so the best policy is linear and
/// known. An episode starts anywhere near 0 and lasts kEpisodeSteps; observations are in odd units.
class LinearTask : public Environment {
 public:
  static constexpr int kStates = 4;  // position and velocity of each cart
  static constexpr int kActions = 2;
  static constexpr int kEpisodeSteps = 40;

  using State = Eigen::Matrix<double, kStates, 1>;
  using Action = Eigen::Matrix<double, kActions, 1>;

  int observation_size() const override { return kStates; }
  int action_size() const override { return kActions; }
  Status Reset(base::Random& random, std::span<float> observation) override;
  StatusOr<Transition> Step(std::span<const float> action, std::span<float> observation) override;

  static void Observe(const State& state, std::span<float> observation);
  static State Next(const State& state, const Action& action);
  static double Cost(const State& state, const Action& action);

  /// The least discounted cost from a state is state^T V state, V by Riccati's recursion.
  static Eigen::Matrix<double, kStates, kStates> LeastCost(double discount);

  static std::vector<std::unique_ptr<Environment>> Make(int count);

 private:
  State state_;
  int steps_ = 0;
};

}  // namespace poise::rl

#endif  // POISE_TESTS_CORE_LEARNING_RL_LINEAR_TASK_H_
