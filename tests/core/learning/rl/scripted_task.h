#ifndef POISE_TESTS_CORE_LEARNING_RL_SCRIPTED_TASK_H_
#define POISE_TESTS_CORE_LEARNING_RL_SCRIPTED_TASK_H_

#include <functional>
#include <memory>
#include <vector>

#include "core/learning/rl/environment.h"

namespace poise::rl {

/// A task whose course is written down: step n of an episode (from 1) earns n and is observed as
/// (episode, n). `at_step` changes what happens.
class ScriptedTask : public Environment {
 public:
  struct Event {
    Transition transition;
    Status status;
    float observation = 0;  ///< replaces the step's number when it is not 0
  };
  /// episode and step count from 1.
  using Script = std::function<void(int episode, int step, Event& event)>;

  explicit ScriptedTask(Script at_step) : at_step_(std::move(at_step)) {}

  int observation_size() const override { return 2; }
  int action_size() const override { return 1; }

  Status Reset(base::Random& random, std::span<float> observation) override {
    (void)random;
    ++episode_;
    step_ = 0;
    observation[0] = static_cast<float>(episode_);
    observation[1] = 0;
    return absl::OkStatus();
  }

  StatusOr<Transition> Step(std::span<const float> action, std::span<float> observation) override {
    actions.push_back(action[0]);
    Event event;
    event.transition.reward = static_cast<float>(++step_);
    at_step_(episode_, step_, event);
    POISE_RETURN_IF_ERROR(event.status);
    observation[0] = static_cast<float>(episode_);
    observation[1] = event.observation != 0 ? event.observation : static_cast<float>(step_);
    return event.transition;
  }

  std::vector<float> actions;  ///< all that it was asked for

 private:
  Script at_step_;
  int episode_ = 0;
  int step_ = 0;
};

}  // namespace poise::rl

#endif  // POISE_TESTS_CORE_LEARNING_RL_SCRIPTED_TASK_H_
