#ifndef POISE_CORE_CORRECTION_IMITATION_IMITATION_LEARNER_H_
#define POISE_CORE_CORRECTION_IMITATION_IMITATION_LEARNER_H_

#include <memory>
#include <string>
#include <string_view>

#include "core/base/run_context.h"
#include "core/correction/policy_learner.h"

namespace poise::correction {

/// Effort `full`: learns one policy for all variants of a clip by PPO, on top of the controller
/// without learning, and corrects variants with it.
/// Source: MotionAug sec. 4.1 (one policy per clip for IK variants), 4.11. We differ: the policy
/// starts as a controller that already stands, residual force and torque are punished, training
/// ends when it gains no more, the best snapshot counts.
class ImitationLearner : public PolicyLearner {
 public:
  /// Errors: kInvalidArgument of the config; those of `variants` and of Corrector::Reference.
  static StatusOr<ImitationLearner> Create(const Corrector& corrector, VariantSource variants,
                                           const ImitationConfig& config, uint64_t seed);
  ImitationLearner(ImitationLearner&&) noexcept;
  ImitationLearner& operator=(ImitationLearner&&) noexcept;
  ~ImitationLearner() override;

  StatusOr<TrainingReport> Train(const base::RunContext& context = {},
                                 const CheckpointSink& checkpoint = {}) override;
  StatusOr<Correction> Correct(const motion::Clip& variant,
                               const base::RunContext& context = {}) const override;
  std::string Save() const override;
  Status Restore(std::string_view checkpoint) override;

  /// By the policy alone. Errors: as Correct.
  StatusOr<Recording> Imitate(const ReferenceMotion& reference,
                              const base::RunContext& context = {}) const;

 private:
  struct State;
  explicit ImitationLearner(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_IMITATION_IMITATION_LEARNER_H_
