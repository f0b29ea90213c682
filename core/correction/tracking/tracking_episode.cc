#include "core/correction/tracking/tracking_episode.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/correction/tracking/stance.h"

namespace poise::correction {
namespace {

using motion::JointRole;
using physics::kMaxBodies;
using physics::SpeedIndex;
using physics::Speeds;
using physics::State;

constexpr double kReferenceMass = 45;  // [kg] whose gains the config holds
constexpr double kFastest = 100;       // [m/s, rad/s] beyond this nothing is simulated any more
constexpr double kContactDistance = 0.001;  // [m] a body this near to the ground touches it

bool IsFoot(int body) {
  return body == static_cast<int>(JointRole::kRightAnkle) ||
         body == static_cast<int>(JointRole::kLeftAnkle);
}

// Height of a body's lowest point.
double LowestPoint(const physics::Body& body, const Vec3& joint, const Quat& rotation) {
  const math::Mat3 axes =
      rotation.toRotationMatrix() * Eigen::Map<const math::Mat3>(body.shape_axes);
  const Vec3 center = joint + rotation * Eigen::Map<const Vec3>(body.shape_center);
  return center.y() - body.radius - body.half_length * std::abs(axes(1, 1)) -
         axes.row(1).cwiseAbs().dot(Eigen::Map<const Vec3>(body.half_extents));
}

// Turn that takes the root where it is wanted, in world axes.
Vec3 RootTurn(const State& now, const State& wanted) {
  return math::ToRotationVector(wanted.rotations[0] * now.rotations[0].conjugate());
}

Status Diverged(int frame) {
  return base::MakeError(absl::StatusCode::kOutOfRange, "DIVERGED", "",
                         fmt::format("the simulation diverged at frame {}", frame));
}

}  // namespace

StatusOr<TrackingEpisode> TrackingEpisode::Create(physics::HumanoidModelPtr model,
                                                  const physics::WorldConfig& world,
                                                  double frame_rate, const TrackingConfig& config) {
  TrackingConfig checked = config;
  POISE_RETURN_IF_ERROR(base::CheckRanges(checked.Fields()));
  const int steps = std::max(1, static_cast<int>(std::lround(world.rate_hz / frame_rate)));
  physics::WorldConfig adjusted = world;
  adjusted.rate_hz = steps * frame_rate;
  POISE_ASSIGN_OR_RETURN(physics::World created,
                         physics::World::Create(model->articulation(), adjusted));
  return TrackingEpisode(std::move(model), std::move(created), steps, config);
}

TrackingEpisode::TrackingEpisode(physics::HumanoidModelPtr model, physics::World world,
                                 int steps_per_frame, const TrackingConfig& config)
    : model_(std::move(model)),
      world_(std::move(world)),
      steps_per_frame_(steps_per_frame),
      steps_per_aim_(
          std::max(1, static_cast<int>(std::lround(1 / (config.control_hz * world_.step_s()))))),
      config_(config) {}

void TrackingEpisode::Start(const ReferenceMotion& reference, int frame) {
  reference_ = &reference;
  drive_ = physics::Drive();
  frame_ = start_frame_ = frame;
  step_ = 0;
  failed_ = false;
  world_.Reset(reference.frame(frame));
}

StatusOr<FrameEffort> TrackingEpisode::Advance(const FrameCommand& command) {
  FrameEffort effort;
  const double start_s = start_frame_ / reference_->frame_rate();
  for (int i = 0; i < steps_per_frame_; ++i, ++step_) {
    if (step_ % steps_per_aim_ == 0) Aim(start_s + step_ * world_.step_s(), command);
    world_.Step(drive_);
    if (failed_) continue;
    ++effort.steps;
    effort.saturated_joints += world_.effort().saturated_joints;
    failed_ = Failed(start_s + (step_ + 1) * world_.step_s());
  }
  ++frame_;
  if (!(world_.state().speeds.cwiseAbs().maxCoeff() < kFastest)) return Diverged(frame_);
  return effort;
}

Speeds TrackingEpisode::FeedForward(double time_s, const State& wanted,
                                    const Speeds& offset) const {
  const State& now = world_.state();
  const physics::Articulation& tree = model_->articulation();
  // With the reference's speeds: those of the simulation would feed its jerks back.
  State moving = now;
  moving.speeds = wanted.speeds;
  Speeds forces =
      physics::InverseDynamics(tree, moving, reference_->AccelerationAt(time_s), world_.gravity());
  const double heavier = model_->config().body_mass_kg / kReferenceMass;
  const Vec3 force =
      forces.head<3>() + offset.head<3>() +
      heavier * (config_.pelvis_stiffness * (wanted.root_position - now.root_position) +
                 config_.pelvis_damping * (wanted.speeds.head<3>() - now.speeds.head<3>()));
  const Vec3 torque = forces.segment<3>(3) +
                      heavier * (config_.pelvis_angular_stiffness * RootTurn(now, wanted) +
                                 config_.pelvis_angular_damping *
                                     (wanted.speeds.segment<3>(3) - now.speeds.segment<3>(3)));
  const double friction = world_.config().friction;
  Stances stances = FindStances(world_, reference_->FootLoads(time_s));
  ShareWrench(now.root_position, force, torque,
              {.friction = friction * friction, .moment_softness_m2 = config_.moment_softness_m2},
              stances);
  forces.head<6>().setZero();  // nobody pushes the root
  return forces + StanceTorques(tree, physics::ComputeFrames(tree, now), stances);
}

void TrackingEpisode::HoldResidual(const State& wanted, const physics::ResidualGains& gains) {
  const State& now = world_.state();
  const Speeds lag = wanted.speeds - now.speeds;
  drive_.feed_forward.head<3>() =
      gains.stiffness * (wanted.root_position - now.root_position) + gains.damping * lag.head<3>();
  drive_.feed_forward.segment<3>(3) =
      gains.angular_stiffness * RootTurn(now, wanted) + gains.angular_damping * lag.segment<3>(3);
}

void TrackingEpisode::Aim(double time_s, const FrameCommand& command) {
  const State wanted = reference_->At(time_s);
  // The implicit solve compares poses at the end of the step; a target that moves is then there.
  const State next = config_.target_velocity ? reference_->At(time_s + world_.step_s()) : wanted;
  drive_.target_rotations = next.rotations;
  for (int i = 1; i < kMaxBodies; ++i) {
    const Vec3 turn = command.offset.segment<3>(SpeedIndex(i));
    if (!turn.isZero(0)) drive_.target_rotations[i] *= math::FromRotationVector(turn);
  }
  drive_.target_root = next.root_position;
  drive_.target_speeds = wanted.speeds;
  if (!config_.target_velocity) drive_.target_speeds.tail<physics::kMaxSpeeds - 6>().setZero();
  drive_.predict_bias = !config_.feed_forward;
  drive_.feed_forward.setZero();
  if (config_.feed_forward) {
    drive_.feed_forward = FeedForward(time_s, wanted, command.offset);
  }
  const physics::ResidualGains gains =
      model_->residual_gains().Scaled(config_.residual_factor * command.residual_scale);
  if (config_.implicit_residual) {
    drive_.residual = gains;
  } else {
    HoldResidual(wanted, gains);
  }
  drive_.feed_forward.head<3>() += command.outer_force;
  drive_.feed_forward.segment<3>(3) += command.outer_torque;
}

bool TrackingEpisode::Failed(double time_s) const {
  const State wanted = reference_->At(time_s);
  const Vec3 pelvis = reference_->SourceRootAt(time_s);
  if ((world_.state().root_position - pelvis).norm() > config_.pelvis_limit_m) return true;
  const physics::Articulation& tree = model_->articulation();
  for (const physics::ContactPoint& contact : world_.contacts()) {
    const int body = contact.body;
    if (contact.other >= 0 || IsFoot(body) || contact.distance > kContactDistance) continue;
    const physics::BodyFrames frames = physics::ComputeFrames(tree, wanted);
    if (LowestPoint(tree.bodies[body], frames.positions[body], frames.rotations[body]) >
        config_.near_floor_m) {
      return true;
    }
  }
  return false;
}

}  // namespace poise::correction
