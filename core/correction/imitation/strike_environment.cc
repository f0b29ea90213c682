#include "core/correction/imitation/strike_environment.h"

#include <algorithm>

namespace poise::correction {

StatusOr<std::unique_ptr<StrikeEnvironment>> StrikeEnvironment::Create(
    const Corrector& corrector, const motion::Clip& clip, int body, StrikeTargets targets,
    const ImitationConfig& imitation, const StrikeConfig& strike) {
  StrikeConfig checked = strike;
  POISE_RETURN_IF_ERROR(base::CheckRanges(checked.Fields()));
  POISE_ASSIGN_OR_RETURN(auto environment, ImitationEnvironment::Create(
                                               corrector, [clip](uint64_t) { return clip; },
                                               clip.frame_rate(), imitation));
  return std::unique_ptr<StrikeEnvironment>(new StrikeEnvironment(
      std::move(environment), body, std::move(targets), imitation.held_out, strike));
}

Status StrikeEnvironment::Reset(base::Random& random, std::span<float> observation) {
  const size_t seen = imitation_->observation_size();
  POISE_RETURN_IF_ERROR(imitation_->Reset(random, observation.first(seen)));
  const auto held_out = static_cast<uint64_t>(held_out_);
  strike_.emplace(config_, body_, targets_(held_out + random.Index(kVariantDraws - held_out)));
  strike_->Observe(episode(), imitation_->reference(), observation.subspan(seen));
  return absl::OkStatus();
}

StatusOr<rl::Transition> StrikeEnvironment::Step(std::span<const float> action,
                                                 std::span<float> observation) {
  const size_t seen = imitation_->observation_size();
  POISE_ASSIGN_OR_RETURN(rl::Transition step, imitation_->Step(action, observation.first(seen)));
  if (step.terminated) {  // perhaps nothing to see
    std::ranges::fill(observation.subspan(seen), 0.0f);
    return step;
  }
  strike_->Observe(episode(), imitation_->reference(), observation.subspan(seen));
  step.reward =
      static_cast<float>((1 - config_.weight) * step.reward + config_.weight * strike_->Reward());
  return step;
}

}  // namespace poise::correction
