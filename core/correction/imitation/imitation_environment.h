#ifndef POISE_CORE_CORRECTION_IMITATION_IMITATION_ENVIRONMENT_H_
#define POISE_CORE_CORRECTION_IMITATION_IMITATION_ENVIRONMENT_H_

#include <memory>
#include <optional>

#include "core/correction/corrector.h"
#include "core/correction/imitation/imitation_spaces.h"
#include "core/correction/policy_learner.h"
#include "core/learning/rl/environment.h"

namespace poise::correction {

/// The task of imitating variants of one clip: each episode draws a new variant and starts at a
/// frame of it, in the reference's pose. It ends with a fall (terminated) or with the motion
/// (truncated).
/// Reward of an action: imitation reward where it ends, less force_weight times the outer force
/// [body weights] and torque_weight times the outer torque [100 N m], both means over its frames;
/// 0 for an action that ends in a fall.
class ImitationEnvironment : public rl::Environment {
 public:
  /// `frame_rate` is that of the variants.
  /// Errors: those of TrackingEpisode::Create.
  static StatusOr<std::unique_ptr<ImitationEnvironment>> Create(const Corrector& corrector,
                                                                VariantSource variants,
                                                                double frame_rate,
                                                                const ImitationConfig& config);

  int observation_size() const override { return spaces_.observation_size(); }
  int action_size() const override { return spaces_.action_size(); }

  /// Errors: those of the variant source; kInvalidArgument WRONG_FRAME_RATE; those of
  /// Corrector::Reference.
  Status Reset(base::Random& random, std::span<float> observation) override;
  StatusOr<rl::Transition> Step(std::span<const float> action,
                                std::span<float> observation) override;

  /// Of the running episode, for who looks on.
  const TrackingEpisode& episode() const { return episode_; }
  const ReferenceMotion& reference() const { return *reference_; }

 private:
  ImitationEnvironment(const Corrector& corrector, VariantSource variants, double frame_rate,
                       const ImitationConfig& config, TrackingEpisode episode);
  double ImitationReward() const;

  Corrector corrector_;
  VariantSource variants_;
  double frame_rate_;
  ImitationConfig config_;
  ImitationSpaces spaces_;
  TrackingEpisode episode_;
  std::optional<ReferenceMotion> reference_;
};

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_IMITATION_IMITATION_ENVIRONMENT_H_
