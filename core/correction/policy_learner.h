#ifndef POISE_CORE_CORRECTION_POLICY_LEARNER_H_
#define POISE_CORE_CORRECTION_POLICY_LEARNER_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/run_context.h"
#include "core/correction/corrector.h"
#include "core/correction/imitation/imitation_config.h"

namespace poise::correction {

/// Makes a variant of the learner's clip, always the same for the same draw.
/// Threads: called from several at a time.
using VariantSource = std::function<StatusOr<motion::Clip>(uint64_t draw)>;

/// Draws are below this; the first ImitationConfig::held_out of them are never trained on.
inline constexpr uint64_t kVariantDraws = 1'000'000;

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
  int best = 0;  ///< index in `curve` of the policy that is kept: the first only if no other came
  int64_t samples = 0;
  double seconds = 0;      ///< of all attempts
  bool converged = false;  ///< no gain for long, else a limit came first
  bool timed_out = false;  ///< the deadline came first; the best so far is kept
};

/// Learns one policy for all variants of a clip, and corrects variants with it. An interface, so
/// that who only passes a learner on loads no LibTorch; ImitationLearner is the one there is.
/// Threads: one caller at a time; Correct may be called from several.
class PolicyLearner {
 public:
  virtual ~PolicyLearner() = default;

  /// Called with Save() after each evaluation; an error ends training with it.
  using CheckpointSink = std::function<Status(std::string checkpoint)>;

  /// Learns until it gains no more, or max_samples, max_seconds or the deadline of `context` come:
  /// then the best so far is kept, and that is no error. May be called again to go on.
  /// Reports progress at the start and after each iteration: step and total are samples; metrics
  /// reward, force, completed (of the best on held-out variants), samples, eta_s.
  /// The same seed gives the same policy on any number of threads, where no time limit cuts it.
  /// Errors: kCancelled; those of the variant source; kInternal NOT_FINITE of rl::Ppo.
  virtual StatusOr<TrainingReport> Train(const base::RunContext& context,
                                         const CheckpointSink& checkpoint) = 0;

  /// The variant as the body imitates it best: by instant and fast, by the policy, and by iterative
  /// learning on top of the policy, whichever has the greatest merit (Correction::effort says
  /// which), so never worse than `fast`. At the deadline the best so far, with timed_out.
  /// Errors: those of Corrector::Correct.
  virtual StatusOr<Correction> Correct(const motion::Clip& variant,
                                       const base::RunContext& context) const = 0;

  /// All that training needs to go on as if it had not stopped, and the best policy.
  virtual std::string Save() const = 0;
  /// Errors: kInvalidArgument MALFORMED_CHECKPOINT; kFailedPrecondition CHECKPOINT_DIFFERS (another
  /// config or seed). Nothing changes then.
  virtual Status Restore(std::string_view checkpoint) = 0;
};

/// Makes a learner that has learned nothing.
/// Errors: kInvalidArgument of the config; those of `variants` and of Corrector::Reference.
using PolicyLearnerFactory = std::function<StatusOr<std::unique_ptr<PolicyLearner>>(
    const Corrector& corrector, VariantSource variants, const ImitationConfig& config,
    uint64_t seed)>;

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_POLICY_LEARNER_H_
