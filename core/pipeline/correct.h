#ifndef POISE_CORE_PIPELINE_CORRECT_H_
#define POISE_CORE_PIPELINE_CORRECT_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/api/correct_spec.h"
#include "core/api/correction_report.h"
#include "core/base/run_context.h"
#include "core/motion/clip.h"
#include "core/pipeline/augment.h"

namespace poise::pipeline {

/// Everything of a CorrectSpec that can be checked without its clips.
/// Errors: those of CorrectSpec::Validate; kInvalidArgument UNKNOWN_METHOD, UNKNOWN_ACTION_CLASS,
/// UNKNOWN_CONFIG_KEY and the other config errors; kFailedPrecondition EFFORT_NOT_AVAILABLE.
Status CheckCorrect(const api::CorrectSpec& spec);

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

/// The correction flow: variants of clips, made by AugmentFlow and imitated by a simulated body,
/// one at a time and in any order. Variant `ordinal` is the one of AugmentFlow, and the same
/// whatever thread corrects it and whatever was corrected before.
/// Threads: all members may be called from several threads.
class CorrectFlow {
 public:
  /// `seed` is that of the variants. Errors: those of CheckCorrect, AugmentFlow::Create and
  /// Corrector::Create; of a clip with the field "sources[i]".
  static StatusOr<std::unique_ptr<CorrectFlow>> Create(const api::CorrectSpec& spec, uint64_t seed,
                                                       std::vector<ResolvedSource> sources);
  ~CorrectFlow();

  int num_sources() const;
  int64_t num_variants() const;
  int variants_per_source() const;
  /// Rollouts that a correction takes: 1 without learning.
  int rollouts() const;
  const std::string& source_name(int source) const;

  /// The preset `paper` without learning, on the source itself. Errors: as Correct; DIVERGED.
  StatusOr<api::ZeroPolicyReport> ZeroPolicy(int source, const base::RunContext& context) const;

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
