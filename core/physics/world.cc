#include "core/physics/world.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/isa.h"
#include "core/physics/bullet_engine.h"

namespace poise::physics {
namespace {

constexpr int kMaxJointsInChain = 6;

Status BadArticulation(const std::string& message) {
  return base::InvalidArgument("BAD_ARTICULATION", "articulation", message);
}

Status CheckBody(const Articulation& tree, int i) {
  const Body& body = tree.bodies[i];
  if ((i == 0) != (body.parent < 0) || body.parent >= i) {
    return BadArticulation(
        fmt::format("body {} has parent {}, expected an earlier one", i, body.parent));
  }
  int joints = 0;
  for (int up = i; up > 0; up = tree.bodies[up].parent) ++joints;
  if (joints > kMaxJointsInChain) {
    return BadArticulation(fmt::format("body {} hangs below {} joints, expected at most {}", i,
                                       joints, kMaxJointsInChain));
  }
  const auto inertia = Eigen::Map<const math::Mat3>(body.inertia);
  const bool positive = body.mass > 0 && inertia.llt().info() == Eigen::Success &&
                        inertia.allFinite() && std::isfinite(body.mass);
  if (positive) return absl::OkStatus();
  return BadArticulation(fmt::format("mass and inertia of body {} must be positive", i));
}

Status CheckArticulation(const Articulation& tree) {
  if (tree.num_bodies < 1 || tree.num_bodies > kMaxBodies) {
    return BadArticulation(fmt::format("{} bodies, expected 1 to {}", tree.num_bodies, kMaxBodies));
  }
  for (int i = 0; i < tree.num_bodies; ++i) POISE_RETURN_IF_ERROR(CheckBody(tree, i));
  return absl::OkStatus();
}

StepSettings MakeSettings(const WorldConfig& config) {
  StepSettings settings;
  settings.step_s = 1 / config.rate_hz;
  settings.substeps = config.substeps;
  settings.gravity[1] = -config.gravity_mps2;
  settings.friction = config.friction * config.friction;
  settings.contact_erp = config.contact_erp;
  settings.warm_start = config.warm_start;
  settings.solver_iterations = config.solver_iterations;
  settings.ground = config.ground;
  settings.self_collision = config.self_collision;
  settings.conserve_momentum = config.conserve_momentum;
  return settings;
}

}  // namespace

StatusOr<World> World::Create(const Articulation& articulation, const WorldConfig& config) {
  WorldConfig checked = config;
  POISE_RETURN_IF_ERROR(base::CheckRanges(checked.Fields()));
  POISE_RETURN_IF_ERROR(CheckArticulation(articulation));
  if (config.engine == "bullet" && articulation.fixed_base) {
    return base::InvalidArgument("UNSUPPORTED_ENGINE", "engine",
                                 "the engine 'bullet' takes a floating base only");
  }
  return World(articulation, config);
}

World::World(const Articulation& articulation, const WorldConfig& config)
    : articulation_(std::make_unique<Articulation>(articulation)),
      config_(config),
      settings_(MakeSettings(config)) {
  if (config.engine == "bullet") {
    bullet_ = std::make_unique<BulletEngine>(*articulation_, settings_);
  }
  Reset(State());
}

World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

void World::Reset(const State& state) {
  StepState fresh;
  std::copy_n(state.root_position.data(), 3, fresh.root_position);
  std::copy_n(state.rotations[0].coeffs().data(), 4 * kMaxBodies, fresh.rotations);
  std::copy_n(state.speeds.data(), kMaxSpeeds, fresh.speeds);
  for (int i = 1; i < articulation_->num_bodies; ++i) {
    if (articulation_->bodies[i].rigid_joint) std::fill_n(fresh.speeds + SpeedIndex(i), 3, 0.0);
  }
  Restore(fresh);
}

void World::Restore(const StepState& saved) {
  memory_ = saved;
  effort_ = Effort();
  ReadMemory();
  if (bullet_) bullet_->Reset(memory_);
}

void World::ReadMemory() {
  std::copy_n(memory_.root_position, 3, state_.root_position.data());
  std::copy_n(memory_.rotations, 4 * kMaxBodies, state_.rotations[0].coeffs().data());
  std::copy_n(memory_.speeds, kMaxSpeeds, state_.speeds.data());
}

StepDrive World::PlainDrive(const Drive& drive) const {
  StepDrive plain;
  plain.target_rotations = drive.target_rotations[0].coeffs().data();
  plain.target_speeds = drive.target_speeds.data();
  plain.target_root = drive.target_root.data();
  plain.feed_forward = drive.feed_forward.data();
  plain.predict_bias = drive.predict_bias;
  plain.root_stiffness[0] = drive.residual.stiffness;
  plain.root_stiffness[1] = drive.residual.angular_stiffness;
  plain.root_damping[0] = drive.residual.damping;
  plain.root_damping[1] = drive.residual.angular_damping;
  return plain;
}

void World::Step(const Drive& drive) {
  static const auto step =
      base::SelectKernel(isa_v2::StepKernel, isa_v3::StepKernel, isa_v4::StepKernel);
  StepEffort effort;
  if (bullet_) {
    bullet_->Step(PlainDrive(drive), memory_, effort);
  } else {
    step(*articulation_, settings_, PlainDrive(drive), memory_, effort);
  }
  ReadMemory();
  effort_.torques = Eigen::Map<const Speeds>(effort.torques);
  effort_.residual_force = Eigen::Map<const Vec3>(effort.residual);
  effort_.residual_torque = Eigen::Map<const Vec3>(effort.residual + 3);
  effort_.saturated_joints = effort.num_saturated;
}

std::span<const ContactPoint> World::contacts() const {
  return {memory_.contacts, static_cast<size_t>(memory_.num_contacts)};
}

}  // namespace poise::physics
