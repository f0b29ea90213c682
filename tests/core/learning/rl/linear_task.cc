#include "tests/core/learning/rl/linear_task.h"

#include <Eigen/LU>

namespace poise::rl {
namespace {

constexpr double kStep_s = 0.2;
constexpr double kKeptVelocity = 0.8;  // after a step, the rest is friction
constexpr double kVelocityWeight = 0.1, kActionWeight = 0.05;
constexpr double kOffset = 30, kUnit = 7;  // of observations

using StateMatrix = Eigen::Matrix<double, LinearTask::kStates, LinearTask::kStates>;
using InputMatrix = Eigen::Matrix<double, LinearTask::kStates, LinearTask::kActions>;

// x' = A x + B u, cost x^T Q x + u^T R u.
StateMatrix A() {
  StateMatrix a = StateMatrix::Identity();
  a(0, 2) = a(1, 3) = kStep_s;
  a(2, 2) = a(3, 3) = kKeptVelocity;
  return a;
}
InputMatrix B() {
  InputMatrix b = InputMatrix::Zero();
  b(2, 0) = b(3, 1) = kStep_s;
  return b;
}
StateMatrix Q() { return LinearTask::State(1, 1, kVelocityWeight, kVelocityWeight).asDiagonal(); }
Eigen::Matrix2d R() { return kActionWeight * Eigen::Matrix2d::Identity(); }

}  // namespace

Status LinearTask::Reset(base::Random& random, std::span<float> observation) {
  for (double& value : state_) value = random.Normal();
  steps_ = 0;
  Observe(state_, observation);
  return absl::OkStatus();
}

StatusOr<Transition> LinearTask::Step(std::span<const float> action, std::span<float> observation) {
  const Action push(action[0], action[1]);
  const double cost = Cost(state_, push);
  state_ = Next(state_, push);
  Observe(state_, observation);
  return Transition{.reward = static_cast<float>(-cost), .truncated = ++steps_ == kEpisodeSteps};
}

void LinearTask::Observe(const State& state, std::span<float> observation) {
  for (int i = 0; i < kStates; ++i) {
    observation[i] = static_cast<float>(kOffset + kUnit * (i + 1) * state[i]);
  }
}

LinearTask::State LinearTask::Next(const State& state, const Action& action) {
  return A() * state + B() * action;
}

double LinearTask::Cost(const State& state, const Action& action) {
  return state.dot(Q() * state) + action.dot(R() * action);
}

StateMatrix LinearTask::LeastCost(double discount) {
  constexpr int kRounds = 1000;
  const StateMatrix a = A();
  const InputMatrix b = B();
  StateMatrix v = Q();
  for (int i = 0; i < kRounds; ++i) {
    const Eigen::Matrix2d s = R() + discount * b.transpose() * v * b;
    const auto gain = (discount * s.inverse() * b.transpose() * v * a).eval();
    v = (Q() + discount * a.transpose() * v * (a - b * gain)).eval();
  }
  return v;
}

std::vector<std::unique_ptr<Environment>> LinearTask::Make(int count) {
  std::vector<std::unique_ptr<Environment>> environments;
  for (int i = 0; i < count; ++i) environments.push_back(std::make_unique<LinearTask>());
  return environments;
}

}  // namespace poise::rl
