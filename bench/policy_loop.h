#ifndef POISE_BENCH_POLICY_LOOP_H_
#define POISE_BENCH_POLICY_LOOP_H_

#include <memory>
#include <vector>

#include "bench/tracked_world.h"
#include "core/learning/rl/fast_mlp.h"

namespace poise::bench {

/// Random weights that neither grow nor shrink what passes them.
std::vector<rl::LayerWeights> RandomLayers(const std::vector<int>& sizes);

/// Worlds of one thread, steered by a policy (200-1024-512-52) and judged by a value network
/// (200-1024-512-1), each evaluated once for all worlds.
class PolicyLoop {
 public:
  PolicyLoop(const physics::HumanoidModel& model, const physics::WorldConfig& config,
             int num_worlds);

  /// One control step of each world.
  void ControlSteps();

 private:
  std::vector<std::unique_ptr<TrackedWorld>> worlds_;
  rl::FastMlp policy_;
  rl::FastMlp value_;
  rl::FastMlp::Scratch scratch_;
  std::vector<float> observations_, actions_, values_;  // (worlds, each one's size)
};

}  // namespace poise::bench

#endif  // POISE_BENCH_POLICY_LOOP_H_
