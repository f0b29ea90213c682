#ifndef POISE_BENCH_MUJOCO_HUMANOID_H_
#define POISE_BENCH_MUJOCO_HUMANOID_H_

#include <memory>
#include <string>

#include "core/physics/world.h"

namespace poise::bench {

/// The same bodies, gains and ground in MuJoCo, for comparison: joints are springs towards the
/// targets plus implicitly integrated damping, as its users would write a PD controller.
class MujocoHumanoid {
 public:
  struct Options {
    std::string solver = "Newton";  ///< Newton, PGS or CG
    bool self_collision = true;
    double rate_hz = 600;
  };
  MujocoHumanoid(const physics::Articulation& tree, const Options& options);
  ~MujocoHumanoid();

  void Reset(const physics::State& state);
  /// `steps` steps towards the drive's targets, with its residual wrench.
  void Advance(const physics::Drive& drive, int steps);
  /// False once the simulation has blown up.
  bool Finite() const;

 private:
  struct Simulation;
  std::unique_ptr<Simulation> simulation_;
  int num_bodies_;
};

}  // namespace poise::bench

#endif  // POISE_BENCH_MUJOCO_HUMANOID_H_
