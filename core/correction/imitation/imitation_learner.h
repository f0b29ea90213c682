#ifndef POISE_CORE_CORRECTION_IMITATION_IMITATION_LEARNER_H_
#define POISE_CORE_CORRECTION_IMITATION_IMITATION_LEARNER_H_

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/run_context.h"
#include "core/correction/imitation/imitation_environment.h"

namespace poise::correction {

/// How well a policy does without noise on the held-out variants: means over them.
struct PolicyScore {
  int64_t samples = 0;  ///< actions that it learned from
  int variants = 0;
  int completed = 0;
  double reward_normalised = 0;  ///< whole motion, 0 after a fall
  double residual_force_mean_bw = 0;
  double residual_force_peak_bw = 0;
  double residual_torque_mean_nm = 0;
  /// What the best is chosen by: share completed + normalised reward - the config's weights times
  /// force and torque.
  double merit = 0;
};

/// What training came to.
struct TrainingReport {
  std::vector<PolicyScore> curve;  ///< the first is the policy before it learned
  int best = 0;                    ///< index in `curve` of the policy that is kept
  int64_t samples = 0;
  double seconds = 0;      ///< of all attempts
  bool converged = false;  ///< no gain for long, else a limit came first
  bool timed_out = false;  ///< the deadline came first; the best so far is kept
};

/// Effort `full`: learns one policy for all variants of a clip by PPO, on top of the controller
/// without learning, and corrects variants with it.
/// Source: MotionAug sec. 4.1 (one policy per clip for IK variants), 4.11. We differ: the policy
/// starts as a controller that already stands, residual force and torque are punished, training
/// ends when it gains no more, the best snapshot counts.
/// Threads: one caller at a time; Correct may be called from several.
class ImitationLearner {
 public:
  /// Called with Save() after each evaluation; an error ends training with it.
  using CheckpointSink = std::function<Status(std::string checkpoint)>;

  /// Errors: kInvalidArgument of the config; those of `variants` and of Corrector::Reference.
  static StatusOr<ImitationLearner> Create(const Corrector& corrector, VariantSource variants,
                                           const ImitationConfig& config, uint64_t seed);
  ImitationLearner(ImitationLearner&&) noexcept;
  ImitationLearner& operator=(ImitationLearner&&) noexcept;
  ~ImitationLearner();

  /// Learns until it gains no more, or max_samples, max_seconds or the deadline of `context` come:
  /// then the best so far is kept, and that is no error. May be called again to go on.
  /// Reports progress after each iteration: step and total are samples; metrics reward, force,
  /// completed (of the best on held-out variants), samples, eta_s.
  /// The same seed gives the same policy on any number of threads, where no time limit cuts it.
  /// Errors: kCancelled; those of the variant source; kInternal NOT_FINITE of rl::Ppo.
  StatusOr<TrainingReport> Train(const base::RunContext& context = {},
                                 const CheckpointSink& checkpoint = {});

  /// The variant as the body imitates it best: by instant and fast, by the policy, and by iterative
  /// learning on top of the policy, whichever has the greatest merit (Correction::effort says
  /// which), so never worse than `fast`. At the deadline the best so far, with timed_out.
  /// Errors: those of Corrector::Correct.
  StatusOr<Correction> Correct(const motion::Clip& variant,
                               const base::RunContext& context = {}) const;
  /// By the policy alone. Errors: as Correct.
  StatusOr<Recording> Imitate(const ReferenceMotion& reference,
                              const base::RunContext& context = {}) const;

  /// All that training needs to go on as if it had not stopped, and the best policy.
  std::string Save() const;
  /// Errors: kInvalidArgument MALFORMED_CHECKPOINT; kFailedPrecondition CHECKPOINT_DIFFERS (another
  /// config or seed). Nothing changes then.
  Status Restore(std::string_view checkpoint);

 private:
  struct State;
  explicit ImitationLearner(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_IMITATION_IMITATION_LEARNER_H_
