#include "bench/tracked_world.h"

#include <cmath>
#include <cstdlib>

#include "bench/bench_clip.h"

namespace poise::bench {

using physics::Vec3;

physics::HumanoidModelPtr TrackedModel() {
  const motion::Clip clip = CapturedSizeClip(120, 120);
  const motion::JointRoles roles = *motion::JointRoles::Detect(*clip.skeleton());
  physics::HumanoidConfig config;
  config.fixed_wrists = false;
  return *physics::HumanoidModel::Create(clip, roles, config);
}

physics::State TrackedStart() {
  physics::State state;
  state.root_position = Vec3(0, 0.95, 0);
  return state;
}

physics::Drive TrackedDrive(const physics::HumanoidModel& model, int step) {
  physics::Drive drive;
  drive.residual = model.residual_gains();
  drive.target_root = TrackedStart().root_position;
  for (int i = 1; i < physics::kMaxBodies; ++i) {
    const double phase = 0.1 * step + i;
    drive.target_rotations[i] =
        math::FromRotationVector(Vec3(0.3 * std::sin(phase), 0.15 * std::sin(1.3 * phase), 0.1));
  }
  return drive;
}

TrackedWorld::TrackedWorld(const physics::HumanoidModel& model, const physics::WorldConfig& config)
    : model_(model),
      world_(std::move(physics::World::Create(model.articulation(), config)).value()),
      wanted_(correction::ComputeFeatures(model, TrackedStart())) {
  world_.Reset(TrackedStart());
}

void TrackedWorld::Observe(std::span<float> observation) const {
  const physics::State& state = world_.state();
  const physics::BodyFrames frames = physics::ComputeFrames(model_.articulation(), state);
  Eigen::Map<Eigen::VectorXf> out(observation.data(), kObservationSize);
  for (int i = 0; i < physics::kMaxBodies; ++i) {
    const Eigen::Matrix3f axes = frames.rotations[i].toRotationMatrix().cast<float>();
    out.segment<3>(9 * i) = (frames.positions[i] - state.root_position).cast<float>();
    out.segment<3>(9 * i + 3) = axes.col(0);
    out.segment<3>(9 * i + 6) = axes.col(1);
  }
  constexpr int kSpeeds = 9 * physics::kMaxBodies;
  out.segment<physics::kMaxSpeeds>(kSpeeds) = 0.1f * state.speeds.cast<float>();
  const float phase = static_cast<float>(step_ % kStepsPerRun) / kStepsPerRun;
  out.tail<5>() << state.root_position.cast<float>(), std::sin(phase), std::cos(phase);
}

void TrackedWorld::ControlStep(std::span<const float> action) {
  constexpr double kActionScale = 0.02;  // [rad, m]
  if (step_ % kStepsPerRun == 0) world_.Reset(TrackedStart());
  physics::Drive drive = TrackedDrive(model_, step_++ % kStepsPerRun);
  if (!action.empty()) {
    const Eigen::VectorXd shift =
        kActionScale * Eigen::Map<const Eigen::VectorXf>(action.data(), kActionSize).cast<double>();
    drive.target_root += shift.head<3>();
    for (int i = 1; i < physics::kMaxBodies; ++i) {
      drive.target_rotations[i] =
          drive.target_rotations[i] * math::FromRotationVector(shift.segment<3>(3 * i));
    }
  }
  for (int update = 0; update < kUpdatesPerControlStep; ++update) world_.Step(drive);
  const correction::Reward reward = correction::ComputeReward(
      model_, {}, correction::ComputeFeatures(model_, world_.state()), wanted_,
      world_.effort().residual_force, world_.effort().residual_torque);
  if (!std::isfinite(reward.total)) std::abort();
}

}  // namespace poise::bench
