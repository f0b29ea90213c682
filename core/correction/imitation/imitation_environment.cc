#include "core/correction/imitation/imitation_environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace poise::correction {
namespace {

constexpr double kGravity = 9.8;    // [m/s2] of a body weight
constexpr double kSameRate = 1e-6;  // relative

}  // namespace

StatusOr<std::unique_ptr<ImitationEnvironment>> ImitationEnvironment::Create(
    const Corrector& corrector, VariantSource variants, double frame_rate,
    const ImitationConfig& config) {
  POISE_RETURN_IF_ERROR(config.Validate());
  POISE_ASSIGN_OR_RETURN(TrackingEpisode episode,
                         TrackingEpisode::Create(corrector.shared_model(), corrector.config().world,
                                                 frame_rate, corrector.config().tracking));
  return std::unique_ptr<ImitationEnvironment>(new ImitationEnvironment(
      corrector, std::move(variants), frame_rate, config, std::move(episode)));
}

ImitationEnvironment::ImitationEnvironment(const Corrector& corrector, VariantSource variants,
                                           double frame_rate, const ImitationConfig& config,
                                           TrackingEpisode episode)
    : corrector_(corrector),
      variants_(std::move(variants)),
      frame_rate_(frame_rate),
      config_(config),
      spaces_(corrector.shared_model(), corrector.config().tracking, config),
      episode_(std::move(episode)) {}

Status ImitationEnvironment::Reset(base::Random& random, std::span<float> observation) {
  const auto held_out = static_cast<uint64_t>(config_.held_out);
  const uint64_t draw = held_out + random.Index(kVariantDraws - held_out);
  POISE_ASSIGN_OR_RETURN(const motion::Clip variant, variants_(draw));
  if (std::abs(variant.frame_rate() / frame_rate_ - 1) > kSameRate) {
    return base::InvalidArgument(
        "WRONG_FRAME_RATE", "clip",
        fmt::format("variant '{}' has {} frames per second, the learner's clip {}", variant.name(),
                    variant.frame_rate(), frame_rate_));
  }
  POISE_ASSIGN_OR_RETURN(reference_, corrector_.Reference(variant));
  const bool from_start = random.Uniform() < config_.start_share;
  const uint64_t frame = random.Index(reference_->num_frames() - 1);
  episode_.Start(*reference_, from_start ? 0 : static_cast<int>(frame));
  spaces_.Observe(episode_, *reference_, observation);
  return absl::OkStatus();
}

StatusOr<rl::Transition> ImitationEnvironment::Step(std::span<const float> action,
                                                    std::span<float> observation) {
  const int last = reference_->num_frames() - 1;
  const FrameCommand command = spaces_.Command(action, reference_->frame(episode_.frame()));
  const physics::Effort& effort = episode_.world().effort();
  double force = 0, torque = 0;
  int frames = 0;
  while (frames < FramesPerAction(config_, frame_rate_) && episode_.frame() < last) {
    const Status advanced = episode_.Advance(command).status();
    if (absl::IsOutOfRange(advanced)) {  // diverged: as bad as a fall, and nothing to see
      std::ranges::fill(observation, 0.0f);
      return rl::Transition{.reward = 0, .terminated = true};
    }
    POISE_RETURN_IF_ERROR(advanced);
    force += effort.residual_force.norm();
    torque += effort.residual_torque.norm();
    ++frames;
  }
  spaces_.Observe(episode_, *reference_, observation);
  if (episode_.failed()) return rl::Transition{.reward = 0, .terminated = true};
  const double weight = corrector_.model().total_mass() * kGravity;
  return rl::Transition{.reward = static_cast<float>(
                            ImitationReward() - config_.force_weight * force / frames / weight -
                            config_.torque_weight * torque / frames / kTorqueUnit),
                        .truncated = episode_.frame() >= last};
}

double ImitationEnvironment::ImitationReward() const {
  const physics::HumanoidModel& model = corrector_.model();
  const physics::Effort& effort = episode_.world().effort();
  const Reward reward = ComputeReward(
      model, corrector_.config().reward, ComputeFeatures(model, episode_.world().state()),
      ComputeFeatures(model, reference_->source_frame(episode_.frame())), effort.residual_force,
      effort.residual_torque);
  return config_.residual_term ? reward.total : reward.imitation;
}

}  // namespace poise::correction
