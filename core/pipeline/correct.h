#ifndef POISE_CORE_PIPELINE_CORRECT_H_
#define POISE_CORE_PIPELINE_CORRECT_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/api/correct_spec.h"
#include "core/api/correction_report.h"
#include "core/base/run_context.h"
#include "core/correction/debias/debiaser.h"
#include "core/correction/policy_learner.h"
#include "core/motion/clip.h"
#include "core/pipeline/augment.h"

namespace poise::pipeline {

/// A variant after the body has imitated it.
struct CorrectedVariant {
  int source_index = 0;
  api::CorrectedVariantReport report;
  std::optional<motion::Clip> clip;     ///< absent when there is no correction (report.error)
  std::string file_data;                ///< the file, once somebody has written the clip
  std::vector<api::RewardPoint> curve;  ///< one point a rollout
  int64_t samples = 0;                  ///< control steps simulated
  bool timed_out = false;               ///< the deadline came before the effort was made
};

/// What the effort `full` learned of one source; goes on from attempt to attempt.
struct LearnedPolicy {
  std::string checkpoint;  ///< of the PolicyLearner; empty: nothing yet
  bool finished = false;
  std::string stopped_by;               ///< see CorrectedClipReport
  std::vector<api::RewardPoint> curve;  ///< on variants that it did not learn from
  int64_t samples = 0;                  ///< actions that it learned from
};

/// Makes the learner of effort full; made by a target that links LibTorch (make_policy_learner.h).
using PolicyLearnerFactory = correction::PolicyLearnerFactory;

/// What only some requests need. The first two take LibTorch to make (poise_training).
struct CorrectNetworks {
  PolicyLearnerFactory make_learner = {};      ///< effort full
  MotionDecoderPtr decoder = nullptr;          ///< step "vae" of the method
  correction::DebiaserPtr debiaser = nullptr;  ///< undoes the character's habits; none: nothing
};

/// The correction flow: variants of clips, made by AugmentFlow and imitated by a simulated body,
/// one at a time and in any order. Variant `ordinal` is the one of AugmentFlow, and the same
/// whatever thread corrects it and whatever was corrected before. With the effort `full` a policy
/// is learned for a source before its variants, from other variants of the same method.
/// Threads: all members may be called from several threads, Learn from one for each source and
/// before its variants.
class CorrectFlow {
 public:
  /// `seed` is that of the variants. Errors: those of CheckCorrect, AugmentFlow::Create and
  /// Corrector::Create; of a clip with the field "sources[i]"; kFailedPrecondition NO_NETWORKS
  /// when a policy is to be learned and nothing makes a learner; SIGNATURE_MISMATCH when a source
  /// cannot be debiased.
  static StatusOr<std::unique_ptr<CorrectFlow>> Create(const api::CorrectSpec& spec, uint64_t seed,
                                                       std::vector<ResolvedSource> sources,
                                                       CorrectNetworks networks = {});
  ~CorrectFlow();

  int num_sources() const;
  int64_t num_variants() const;
  int variants_per_source() const;
  /// Frames that a correction simulates: all rollouts of a variant of this source.
  int64_t samples_per_variant(int source) const;
  /// The same of a zero policy.
  int64_t frames(int source) const;
  /// Whether a policy is learned (effort full), and from how many samples at most.
  bool learns() const;
  int64_t max_training_samples() const;
  const std::string& source_name(int source) const;

  /// The preset `paper` without learning, on the source itself. Errors: as Correct; DIVERGED.
  StatusOr<api::ZeroPolicyReport> ZeroPolicy(int source, const base::RunContext& context) const;

  /// Learns the policy that Correct then uses, from where `policy` is; one that is finished is only
  /// read. `save` gets it now and then. Stops when the policy gains no more, and at the limits of
  /// the learner's config. Progress: see PolicyLearner. Errors: kCancelled, kDeadlineExceeded of
  /// `context`; those of PolicyLearner and of `save`.
  Status Learn(int source, const base::RunContext& context,
               const std::function<Status(const LearnedPolicy&)>& save, LearnedPolicy& policy);

  /// With deadlines the best until context.deadline; when that comes before the first rollout ends,
  /// the controller without learning until `last_call`; when that comes too, a report with the
  /// error OUT_OF_TIME. A simulation that diverges is a report, too. Progress: rollouts.
  /// Errors: kCancelled; kInternal when a number became NaN; those of Corrector::Correct.
  StatusOr<CorrectedVariant> Correct(int64_t ordinal, const base::RunContext& context,
                                     absl::Time last_call = absl::InfiniteFuture()) const;

 private:
  class Implementation;
  explicit CorrectFlow(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_CORRECT_H_
