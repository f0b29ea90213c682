#ifndef POISE_BENCH_TRACKED_WORLD_H_
#define POISE_BENCH_TRACKED_WORLD_H_

#include <span>

#include "core/correction/reward.h"
#include "core/physics/world.h"

/// What the simulation's benchmarks simulate: the humanoid with 51 degrees of freedom tracks
/// swinging targets with its residual wrench, gets its reward after each control step of 1/30 s,
/// and starts anew every 60 steps, so that it stands, staggers and lies.
namespace poise::bench {

inline constexpr int kStepsPerRun = 60;
inline constexpr int kUpdatesPerControlStep = 20;  // 600 Hz
inline constexpr int kObservationSize = 200;
inline constexpr int kActionSize = 52;

physics::HumanoidModelPtr TrackedModel();
physics::State TrackedStart();
physics::Drive TrackedDrive(const physics::HumanoidModel& model, int step);

class TrackedWorld {
 public:
  TrackedWorld(const physics::HumanoidModel& model, const physics::WorldConfig& config);

  /// Bodies' positions and axes about the root, speeds, root position, phase (kObservationSize).
  void Observe(std::span<float> observation) const;
  /// One control step. `action` (kActionSize, or empty for none) turns the targets and shifts the
  /// one of the residual, by little.
  void ControlStep(std::span<const float> action = {});

 private:
  const physics::HumanoidModel& model_;
  physics::World world_;
  correction::Features wanted_;
  int step_ = 0;
};

}  // namespace poise::bench

#endif  // POISE_BENCH_TRACKED_WORLD_H_
