#ifndef POISE_CORE_CORRECTION_IMITATION_STRIKE_ENVIRONMENT_H_
#define POISE_CORE_CORRECTION_IMITATION_STRIKE_ENVIRONMENT_H_

#include <functional>
#include <memory>
#include <optional>

#include "core/correction/imitation/imitation_environment.h"
#include "core/correction/imitation/strike.h"

namespace poise::correction {

/// Where the target of a draw is in the world [m].
/// Threads: called from several at a time.
using StrikeTargets = std::function<Vec3(uint64_t draw)>;

/// The task of the strike baseline: always the same clip is imitated, with a new target for one
/// limb in each episode. Observations are those of ImitationEnvironment and then Strike's.
class StrikeEnvironment : public rl::Environment {
 public:
  /// Errors: those of ImitationEnvironment::Create; kInvalidArgument CONFIG_VALUE_OUT_OF_RANGE.
  static StatusOr<std::unique_ptr<StrikeEnvironment>> Create(const Corrector& corrector,
                                                             const motion::Clip& clip, int body,
                                                             StrikeTargets targets,
                                                             const ImitationConfig& imitation,
                                                             const StrikeConfig& strike);

  int observation_size() const override {
    return imitation_->observation_size() + Strike::kObservationSize;
  }
  int action_size() const override { return imitation_->action_size(); }

  Status Reset(base::Random& random, std::span<float> observation) override;
  /// Reward: StrikeConfig's mean of the imitation's and the strike's; 0 for a fall.
  StatusOr<rl::Transition> Step(std::span<const float> action,
                                std::span<float> observation) override;

  /// Of the running episode, for who looks on.
  const TrackingEpisode& episode() const { return imitation_->episode(); }
  const Strike& strike() const { return *strike_; }

 private:
  StrikeEnvironment(std::unique_ptr<ImitationEnvironment> imitation, int body,
                    StrikeTargets targets, int held_out, const StrikeConfig& config)
      : imitation_(std::move(imitation)),
        body_(body),
        targets_(std::move(targets)),
        held_out_(held_out),
        config_(config) {}

  std::unique_ptr<ImitationEnvironment> imitation_;
  int body_;
  StrikeTargets targets_;
  int held_out_;
  StrikeConfig config_;
  std::optional<Strike> strike_;
};

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_IMITATION_STRIKE_ENVIRONMENT_H_
