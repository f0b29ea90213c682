#include "core/correction/imitation/imitation_spaces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/correction/reward.h"

namespace poise::correction {
namespace {

using physics::SpeedIndex;
using physics::Speeds;
using physics::State;

constexpr double kReferenceMass = 45;  // [kg] whose forces the config holds
constexpr double kTouching = 0.002;    // [m] a foot this near to the ground touches it
constexpr int kHarmonics = 4;          // of the part that has passed
constexpr std::array kFeet = {motion::JointRole::kRightAnkle, motion::JointRole::kLeftAnkle};

// Writes numbers one after another.
class Writer {
 public:
  explicit Writer(std::span<float> to) : to_(to) {}
  void Add(double value) { to_[at_++] = static_cast<float>(value); }
  void Add(const Vec3& value) {
    for (int k = 0; k < 3; ++k) Add(value[k]);
  }

 private:
  std::span<float> to_;
  size_t at_ = 0;
};

Vec3 Turn(const Quat& from, const Quat& to) {
  return math::ToRotationVector(from.conjugate() * to);
}

bool Touches(const physics::World& world, int body) {
  return std::ranges::any_of(world.contacts(), [&](const physics::ContactPoint& contact) {
    return contact.body == body && contact.other < 0 && contact.distance < kTouching;
  });
}

void AddJoints(const std::vector<int>& motors, const State& now, const State& wanted,
               const State& ahead, Writer& out) {
  for (int i : motors) out.Add(Turn(now.rotations[i], wanted.rotations[i]));
  for (int i : motors) out.Add(Vec3(now.speeds.segment<3>(SpeedIndex(i))));
  for (int i : motors) out.Add(Vec3(wanted.speeds.segment<3>(SpeedIndex(i))));
  for (int i : motors) out.Add(Turn(wanted.rotations[i], ahead.rotations[i]));
}

void AddPelvis(const Quat& heading, const State& now, const State& wanted, const State& ahead,
               Writer& out) {
  const auto add = [&](const Vec3& world) { out.Add(Vec3(heading * world)); };
  add(wanted.root_position - now.root_position);
  add(math::ToRotationVector(wanted.rotations[0] * now.rotations[0].conjugate()));
  for (int at : {0, 3}) {
    add(wanted.speeds.segment<3>(at) - now.speeds.segment<3>(at));
    add(now.speeds.segment<3>(at));
    add(ahead.speeds.segment<3>(at) - wanted.speeds.segment<3>(at));
  }
  out.Add(now.root_position.y());
  out.Add(Vec3(now.rotations[0].conjugate() * Vec3::UnitY()));
}

void AddFeet(const Quat& heading, const physics::Articulation& tree, const physics::World& world,
             const State& wanted, Writer& out) {
  const State& now = world.state();
  const physics::BodyFrames frames = physics::ComputeFrames(tree, now);
  const physics::BodyFrames targets = physics::ComputeFrames(tree, wanted);
  for (const motion::JointRole role : kFeet) {
    const int foot = static_cast<int>(role);
    out.Add(Vec3(heading * (frames.positions[foot] - now.root_position)));
    out.Add(Vec3(heading * (targets.positions[foot] - frames.positions[foot])));
    out.Add(Touches(world, foot) ? 1 : 0);
  }
}

void AddPhase(double phase, Writer& out) {
  out.Add(phase);
  for (int k = 1; k <= kHarmonics; ++k) {
    out.Add(std::sin(k * std::numbers::pi * phase));
    out.Add(std::cos(k * std::numbers::pi * phase));
  }
}

}  // namespace

ImitationSpaces::ImitationSpaces(physics::HumanoidModelPtr model, const TrackingConfig& tracking,
                                 const ImitationConfig& config)
    : model_(std::move(model)), config_(config), asks_legs_(tracking.feed_forward) {
  const physics::Articulation& tree = model_->articulation();
  for (int i = 1; i < tree.num_bodies; ++i) {
    if (!tree.bodies[i].rigid_joint && tree.bodies[i].stiffness > 0) motors_.push_back(i);
  }
  const int joints = 3 * static_cast<int>(motors_.size());
  observation_size_ = 4 * joints + 28 + 7 * static_cast<int>(kFeet.size()) + 1 + 2 * kHarmonics;
  action_size_ = joints + (asks_legs_ ? 6 : 0);
  if (config.residual == "pd_scaled") action_size_ += 1;
  if (config.residual == "rfc" || config.residual == "pd_rfc") action_size_ += 6;
}

void ImitationSpaces::Observe(const TrackingEpisode& episode, const ReferenceMotion& reference,
                              std::span<float> observation) const {
  const physics::World& world = episode.world();
  const int frame = std::min(episode.frame(), reference.num_frames() - 1);
  const State& wanted = reference.frame(frame);
  const State ahead = reference.At(frame / reference.frame_rate() + config_.look_ahead_s);
  const Quat heading = HeadingInverse(wanted.rotations[0]);
  Writer out(observation);
  AddJoints(motors_, world.state(), wanted, ahead, out);
  AddPelvis(heading, world.state(), wanted, ahead, out);
  AddFeet(heading, model_->articulation(), world, wanted, out);
  AddPhase(static_cast<double>(frame) / (reference.num_frames() - 1), out);
}

FrameCommand ImitationSpaces::Command(std::span<const float> action, const State& wanted) const {
  FrameCommand command;
  const Quat world_from_heading = HeadingInverse(wanted.rotations[0]).conjugate();
  size_t at = 0;
  const auto next = [&](double scale) {
    const Vec3 vector(action[at], action[at + 1], action[at + 2]);
    at += 3;
    return Vec3(scale * vector);
  };
  for (int i : motors_) command.offset.segment<3>(SpeedIndex(i)) = next(config_.joint_scale);
  const double heavier = model_->config().body_mass_kg / kReferenceMass;
  if (asks_legs_) {
    command.offset.head<3>() = world_from_heading * next(heavier * config_.force_scale);
    command.offset.segment<3>(3) = world_from_heading * next(heavier * config_.torque_scale);
  }
  if (config_.residual == "none" || config_.residual == "rfc") command.residual_scale = 0;
  if (config_.residual == "pd_scaled") {
    command.residual_scale = std::clamp(1 + config_.residual_scale * action[at], 0.0, 1.0);
  }
  if (config_.residual == "rfc" || config_.residual == "pd_rfc") {
    command.outer_force = world_from_heading * next(heavier * config_.learned_scale);
    command.outer_torque = world_from_heading * next(heavier * config_.learned_scale);
  }
  return command;
}

int FramesPerAction(const ImitationConfig& config, double frame_rate) {
  return std::max(1, static_cast<int>(std::lround(frame_rate / config.control_hz)));
}

}  // namespace poise::correction
