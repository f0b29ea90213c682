#include "core/correction/reward.h"

#include <fmt/format.h>

#include <cmath>

namespace poise::correction {
namespace {

using physics::kMaxBodies;
using physics::SpeedIndex;
using enum motion::JointRole;

constexpr std::array kEndEffectors = {kRightAnkle, kLeftAnkle, kRightWrist, kLeftWrist};

double Squared(double x) { return x * x; }

double RootError(const physics::State& a, const physics::State& b) {
  return (a.root_position - b.root_position).squaredNorm() +
         0.1 * Squared(math::GeodesicDistance(a.rotations[0], b.rotations[0])) +
         0.01 * (a.speeds.head<3>() - b.speeds.head<3>()).squaredNorm() +
         0.001 * (a.speeds.segment<3>(3) - b.speeds.segment<3>(3)).squaredNorm();
}

}  // namespace

StatusOr<RewardConfig> RewardConfig::FromPreset(std::string_view preset) {
  RewardConfig config;
  if (preset == "motionaug") return config;
  if (preset == "rfc") {
    config.pose_weight = 0.3;
    config.velocity_weight = 0.1;
    config.end_effector_weight = 0.45;
    config.end_effector_sum = true;
    config.center_by_position = true;
    config.residual_weight = 0.05;
    config.residual_scale = 1e-4;  // the action is the wrench in units of 100
    config.residual_squared = true;
    return config;
  }
  if (preset == "deepmimic") {
    config.velocity_weight = 0.05;
    config.velocity_scale = 0.1;
    config.end_effector_weight = 0.15;
    config.end_effector_scale = 40;
    config.root_weight = 0.2;
    config.center_scale = 10;
    config.residual_weight = 0;
    return config;
  }
  return base::InvalidArgument(
      "UNKNOWN_PRESET", "reward",
      fmt::format("unknown preset '{}', expected motionaug, rfc or deepmimic", preset));
}

std::vector<base::Field> RewardConfig::Fields() {
  return {
      base::Number("pose_weight", &pose_weight, 0, 1e3),
      base::Number("pose_scale", &pose_scale, 0, 1e6),
      base::Number("velocity_weight", &velocity_weight, 0, 1e3),
      base::Number("velocity_scale", &velocity_scale, 0, 1e6),
      base::Number("end_effector_weight", &end_effector_weight, 0, 1e3),
      base::Number("end_effector_scale", &end_effector_scale, 0, 1e6),
      base::Flag("end_effector_sum", &end_effector_sum),
      base::Number("root_weight", &root_weight, 0, 1e3),
      base::Number("root_scale", &root_scale, 0, 1e6),
      base::Number("center_weight", &center_weight, 0, 1e3),
      base::Number("center_scale", &center_scale, 0, 1e6),
      base::Flag("center_by_position", &center_by_position),
      base::Number("residual_weight", &residual_weight, 0, 1),
      base::Number("residual_scale", &residual_scale, 0, 1e6),
      base::Flag("residual_squared", &residual_squared),
  };
}

Quat HeadingInverse(const Quat& root) {
  Vec3 axis = root * Vec3::UnitX();
  if (std::hypot(axis.x(), axis.z()) < 0.1) axis = root * Vec3::UnitZ();
  return Quat(Eigen::AngleAxisd(std::atan2(axis.z(), axis.x()), Vec3::UnitY()));
}

Features ComputeFeatures(const physics::HumanoidModel& model, const physics::State& state) {
  const physics::Articulation& tree = model.articulation();
  Features features{
      .state = state, .frames = physics::ComputeFrames(tree, state), .end_effectors = {}};
  const physics::Conserved whole = physics::ComputeConserved(tree, state, -Vec3::UnitY());
  const double mass = model.total_mass();
  features.center_velocity = whole.momentum / mass;
  for (int i = 0; i < tree.num_bodies; ++i) {
    const Vec3 local = Eigen::Map<const Vec3>(tree.bodies[i].center_of_mass);
    features.center += tree.bodies[i].mass / mass *
                       (features.frames.positions[i] + features.frames.rotations[i] * local);
  }
  const Quat heading = HeadingInverse(state.rotations[0]);
  for (size_t e = 0; e < kEndEffectors.size(); ++e) {
    const Vec3 at = features.frames.positions[static_cast<int>(kEndEffectors[e])];
    const Vec3 from_root(at.x() - state.root_position.x(), at.y(),
                         at.z() - state.root_position.z());
    features.end_effectors[e] = heading * from_root;
  }
  return features;
}

Reward ComputeReward(const physics::HumanoidModel& model, const RewardConfig& config,
                     const Features& simulated, const Features& reference, const Vec3& force,
                     const Vec3& torque) {
  const physics::State &a = simulated.state, &b = reference.state;
  double pose = 0, velocity = 0, weights = 0;
  for (int i = 0; i < kMaxBodies; ++i) {
    const double weight = model.joint_weights()[i];
    weights += weight;
    pose += weight * Squared(math::GeodesicDistance(a.rotations[i], b.rotations[i]));
    velocity +=
        weight *
        (a.speeds.segment<3>(SpeedIndex(i)) - b.speeds.segment<3>(SpeedIndex(i))).squaredNorm();
  }
  double ends = 0;
  for (size_t e = 0; e < kEndEffectors.size(); ++e) {
    ends += (simulated.end_effectors[e] - reference.end_effectors[e]).squaredNorm();
  }
  if (!config.end_effector_sum) ends /= kEndEffectors.size();
  const double center =
      config.center_by_position
          ? (simulated.center - reference.center).squaredNorm()
          : 0.1 * (simulated.center_velocity - reference.center_velocity).squaredNorm();
  const double wrench2 = force.squaredNorm() + torque.squaredNorm();

  Reward reward;
  reward.pose = std::exp(-config.pose_scale * pose / weights);
  reward.velocity = std::exp(-config.velocity_scale * velocity / weights);
  reward.end_effector = std::exp(-config.end_effector_scale * ends);
  reward.root = std::exp(-config.root_scale * RootError(a, b));
  reward.center = std::exp(-config.center_scale * center);
  reward.residual =
      std::exp(-config.residual_scale * (config.residual_squared ? wrench2 : std::sqrt(wrench2)));
  const double sum = config.pose_weight + config.velocity_weight + config.end_effector_weight +
                     config.root_weight + config.center_weight;
  reward.imitation = (config.pose_weight * reward.pose + config.velocity_weight * reward.velocity +
                      config.end_effector_weight * reward.end_effector +
                      config.root_weight * reward.root + config.center_weight * reward.center) /
                     std::max(sum, 1e-12);
  reward.total =
      (1 - config.residual_weight) * reward.imitation + config.residual_weight * reward.residual;
  return reward;
}

}  // namespace poise::correction
