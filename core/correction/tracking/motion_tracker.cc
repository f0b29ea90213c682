#include "core/correction/tracking/motion_tracker.h"

#include <algorithm>

namespace poise::correction {
namespace {

using physics::kMaxBodies;
using physics::SpeedIndex;
using physics::Speeds;
using physics::State;

constexpr double kGravity = 9.8;  // [m/s2] of a body weight

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

  void AddSteps(const FrameEffort& effort) {
    steps_ += effort.steps;
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
  RewardConfig checked = reward;
  POISE_RETURN_IF_ERROR(base::CheckRanges(checked.Fields()));
  POISE_ASSIGN_OR_RETURN(TrackingEpisode episode,
                         TrackingEpisode::Create(std::move(model), world, frame_rate, config));
  return MotionTracker(std::move(episode), reward);
}

StatusOr<Recording> MotionTracker::Track(const ReferenceMotion& reference,
                                         const base::RunContext& context,
                                         const TrackingOffsets* offsets) {
  return Track(reference, context, [&](const TrackingEpisode& episode) {
    FrameCommand command;
    if (offsets != nullptr) command.offset = (*offsets)[episode.frame()];
    return command;
  });
}

StatusOr<Recording> MotionTracker::Track(const ReferenceMotion& reference,
                                         const base::RunContext& context,
                                         const Commander& commander) {
  const physics::HumanoidModel& model = episode_.model();
  const physics::World& world = episode_.world();
  Recording recording{.clip = reference.clip(), .score = {}, .lags = {}};
  recording.lags.assign(reference.num_frames(), Speeds::Zero());
  Tally tally(model);
  episode_.Start(reference);
  for (int frame = 0; frame < reference.num_frames(); ++frame) {
    POISE_RETURN_IF_ERROR(context.Check());
    Record(model.articulation(), world.state(), frame, recording.clip);
    if (!episode_.failed()) {
      const Features simulated = ComputeFeatures(model, world.state());
      const Features wanted = ComputeFeatures(model, reference.source_frame(frame));
      const physics::Effort& effort = world.effort();
      tally.AddFrame(simulated, wanted,
                     ComputeReward(model, reward_, simulated, wanted, effort.residual_force,
                                   effort.residual_torque),
                     effort);
      recording.lags[frame] = Lag(world.state(), reference.frame(frame), effort);
    }
    POISE_ASSIGN_OR_RETURN(const FrameEffort steps, episode_.Advance(commander(episode_)));
    tally.AddSteps(steps);
  }
  recording.score = tally.Finish(!episode_.failed(), reference.num_frames());
  return recording;
}

}  // namespace poise::correction
