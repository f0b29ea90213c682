#include "core/correction/tracking/motion_tracker.h"

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
constexpr double kGravity = 9.8;       // [m/s2] of a body weight
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

// Sums over the frames until the fall, and what they come to.
class Tally {
 public:
  explicit Tally(const physics::HumanoidModel& model)
      : weight_(model.total_mass() * kGravity), motors_((model.degrees_of_freedom() - 6) / 3) {}

  void AddFrame(const Features& simulated, const Features& wanted, const Reward& reward,
                const physics::Effort& effort) {
    ++frames_;
    score_.reward_imitation += reward.imitation;
    score_.reward_total += reward.total;
    const double force = effort.residual_force.norm() / weight_;
    const double torque = effort.residual_torque.norm();
    score_.residual_force_mean_bw += force;
    score_.residual_torque_mean_nm += torque;
    score_.residual_force_peak_bw = std::max(score_.residual_force_peak_bw, force);
    score_.residual_torque_peak_nm = std::max(score_.residual_torque_peak_nm, torque);
    AddPoseErrors(simulated, wanted);
  }

  void AddStep(const physics::Effort& effort) {
    ++steps_;
    score_.torque_saturation += effort.saturated_joints;
  }

  TrackingScore Finish(bool completed, int all_frames) const {
    TrackingScore score = score_;
    const double until = std::max(frames_, 1);
    score.completed = completed;
    score.completion = static_cast<double>(frames_) / all_frames;
    score.reward_normalised = score_.reward_imitation / all_frames;
    score.reward_total /= all_frames;
    for (double* mean :
         {&score.reward_imitation, &score.residual_force_mean_bw, &score.residual_torque_mean_nm,
          &score.pose_error_rad, &score.pose_error_m, &score.pelvis_error_mean_m}) {
      *mean /= until;
    }
    score.torque_saturation /= std::max(steps_, 1) * motors_;
    return score;
  }

 private:
  void AddPoseErrors(const Features& simulated, const Features& wanted) {
    for (int i = 0; i < kMaxBodies; ++i) {
      score_.pose_error_rad +=
          math::GeodesicDistance(simulated.state.rotations[i], wanted.state.rotations[i]) /
          kMaxBodies;
      score_.pose_error_m +=
          (simulated.frames.positions[i] - wanted.frames.positions[i]).norm() / kMaxBodies;
    }
    const double pelvis = (simulated.state.root_position - wanted.state.root_position).norm();
    score_.pelvis_error_mean_m += pelvis;
    score_.pelvis_error_max_m = std::max(score_.pelvis_error_max_m, pelvis);
  }

  double weight_;  // [N]
  int motors_;
  int frames_ = 0;
  int steps_ = 0;
  TrackingScore score_;  // sums where it will hold means
};

Speeds Lag(const State& simulated, const State& wanted, const physics::Effort& effort) {
  Speeds lag;
  lag.head<3>() = effort.residual_force;
  lag.segment<3>(3) = effort.residual_torque;
  for (int i = 1; i < kMaxBodies; ++i) {
    lag.segment<3>(SpeedIndex(i)) =
        math::ToRotationVector(simulated.rotations[i].conjugate() * wanted.rotations[i]);
  }
  return lag;
}

// The simulated pose as a frame of the clip; what does not move against its parent moves as in the
// reference.
void Record(const physics::Articulation& tree, const State& simulated, int frame,
            motion::Clip& clip) {
  clip.root_position(frame) = simulated.root_position;
  for (int i = 0; i < kMaxBodies; ++i) {
    if (!tree.bodies[i].rigid_joint) clip.rotation(frame, i) = simulated.rotations[i];
  }
}

}  // namespace

StatusOr<MotionTracker> MotionTracker::Create(physics::HumanoidModelPtr model,
                                              const physics::WorldConfig& world, double frame_rate,
                                              const TrackingConfig& config,
                                              const RewardConfig& reward) {
  TrackingConfig checked = config;
  RewardConfig checked_reward = reward;
  POISE_RETURN_IF_ERROR(base::CheckRanges(checked.Fields()));
  POISE_RETURN_IF_ERROR(base::CheckRanges(checked_reward.Fields()));
  const int steps = std::max(1, static_cast<int>(std::lround(world.rate_hz / frame_rate)));
  physics::WorldConfig adjusted = world;
  adjusted.rate_hz = steps * frame_rate;
  POISE_ASSIGN_OR_RETURN(physics::World created,
                         physics::World::Create(model->articulation(), adjusted));
  return MotionTracker(std::move(model), std::move(created), steps, config, reward);
}

MotionTracker::MotionTracker(physics::HumanoidModelPtr model, physics::World world,
                             int steps_per_frame, const TrackingConfig& config,
                             const RewardConfig& reward)
    : model_(std::move(model)),
      world_(std::move(world)),
      steps_per_frame_(steps_per_frame),
      steps_per_aim_(
          std::max(1, static_cast<int>(std::lround(1 / (config.control_hz * world_.step_s()))))),
      config_(config),
      reward_(reward) {}

Speeds MotionTracker::FeedForward(const State& wanted, const Speeds& acceleration,
                                  const Speeds& offset) const {
  const State& now = world_.state();
  const physics::Articulation& tree = model_->articulation();
  // With the reference's speeds: those of the simulation would feed its jerks back.
  State moving = now;
  moving.speeds = wanted.speeds;
  Speeds forces = physics::InverseDynamics(tree, moving, acceleration, world_.gravity());
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
  Stances stances = FindStances(world_);
  ShareWrench(now.root_position, force, torque,
              {.friction = friction * friction, .moment_softness_m2 = config_.moment_softness_m2},
              stances);
  forces.head<6>().setZero();  // nobody pushes the root
  return forces + StanceTorques(tree, physics::ComputeFrames(tree, now), stances);
}

void MotionTracker::HoldResidual(const State& wanted, physics::Drive& drive) const {
  const State& now = world_.state();
  const physics::ResidualGains gains = model_->residual_gains().Scaled(config_.residual_factor);
  const Speeds lag = wanted.speeds - now.speeds;
  drive.feed_forward.head<3>() =
      gains.stiffness * (wanted.root_position - now.root_position) + gains.damping * lag.head<3>();
  drive.feed_forward.segment<3>(3) =
      gains.angular_stiffness * RootTurn(now, wanted) + gains.angular_damping * lag.segment<3>(3);
}

void MotionTracker::Aim(const ReferenceMotion& reference, double time_s, const Speeds& offset,
                        physics::Drive& drive) const {
  const State wanted = reference.At(time_s);
  drive.target_rotations = wanted.rotations;
  for (int i = 1; i < kMaxBodies; ++i) {
    const Vec3 turn = offset.segment<3>(SpeedIndex(i));
    if (!turn.isZero(0)) drive.target_rotations[i] *= math::FromRotationVector(turn);
  }
  drive.target_root = wanted.root_position;
  drive.target_speeds = wanted.speeds;
  if (!config_.target_velocity) drive.target_speeds.tail<physics::kMaxSpeeds - 6>().setZero();
  drive.predict_bias = !config_.feed_forward;
  drive.feed_forward.setZero();
  if (config_.feed_forward) {
    drive.feed_forward = FeedForward(wanted, reference.AccelerationAt(time_s), offset);
  }
  if (config_.implicit_residual) {
    drive.residual = model_->residual_gains().Scaled(config_.residual_factor);
  } else {
    HoldResidual(wanted, drive);
  }
}

bool MotionTracker::Failed(const ReferenceMotion& reference, double time_s) const {
  const State wanted = reference.At(time_s);
  if ((world_.state().root_position - wanted.root_position).norm() > config_.pelvis_limit_m) {
    return true;
  }
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

StatusOr<Recording> MotionTracker::Track(const ReferenceMotion& reference,
                                         const base::RunContext& context,
                                         const TrackingOffsets* offsets) {
  Recording recording{.clip = reference.clip(), .score = {}, .lags = {}};
  recording.lags.assign(reference.num_frames(), Speeds::Zero());
  Tally tally(*model_);
  physics::Drive drive;
  const Speeds none = Speeds::Zero();
  bool failed = false;
  world_.Reset(reference.frame(0));
  for (int frame = 0; frame < reference.num_frames(); ++frame) {
    POISE_RETURN_IF_ERROR(context.Check());
    const State& now = world_.state();
    if (!(now.speeds.cwiseAbs().maxCoeff() < kFastest)) return Diverged(frame);
    Record(model_->articulation(), now, frame, recording.clip);
    if (!failed) {
      const Features simulated = ComputeFeatures(*model_, now);
      const Features wanted = ComputeFeatures(*model_, reference.frame(frame));
      const physics::Effort& effort = world_.effort();
      tally.AddFrame(simulated, wanted,
                     ComputeReward(*model_, reward_, simulated, wanted, effort.residual_force,
                                   effort.residual_torque),
                     effort);
      recording.lags[frame] = Lag(now, reference.frame(frame), effort);
    }
    for (int step = 0; step < steps_per_frame_; ++step) {
      const int count = frame * steps_per_frame_ + step;
      if (count % steps_per_aim_ == 0) {
        Aim(reference, count * world_.step_s(), offsets ? (*offsets)[frame] : none, drive);
      }
      world_.Step(drive);
      if (failed) continue;
      tally.AddStep(world_.effort());
      failed = Failed(reference, (count + 1) * world_.step_s());
    }
  }
  recording.score = tally.Finish(!failed, reference.num_frames());
  return recording;
}

}  // namespace poise::correction
