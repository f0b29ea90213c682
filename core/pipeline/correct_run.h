#ifndef POISE_CORE_PIPELINE_CORRECT_RUN_H_
#define POISE_CORE_PIPELINE_CORRECT_RUN_H_

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "absl/time/time.h"
#include "core/pipeline/correct.h"

namespace poise::pipeline {

/// What is done of a correction; goes on from attempt to attempt.
struct CorrectState {
  std::vector<std::optional<api::ZeroPolicyReport>> zero_policies;  // (sources)
  std::vector<std::optional<CorrectedVariant>> variants;            // (num_variants)
  double seconds = 0;  ///< that it took so far, over all attempts

  static CorrectState Empty(const CorrectFlow& flow);
};

struct CorrectRunConfig {
  int threads = 0;         ///< <= 0: one per available CPU; changes no result
  double max_seconds = 0;  ///< [s] of CorrectState::seconds; 0: no limit
  /// Called with each variant before it counts as done, by the thread that corrected it: writes
  /// its clip to a file. May be empty.
  std::function<Status(CorrectedVariant&)> finish = {};
  /// Called with what is done, whenever that has grown, one call at a time. May be empty.
  std::function<Status(const CorrectState&, int64_t step)> on_done = {};
};

/// Corrects all variants of a flow that are not done, several at a time. Time that is limited is
/// shared: no variant takes so much that a later one gets none.
/// Progress: step counts rollouts; the metrics samples, reward (normalised), force (mean, body
/// weights), torque (mean, N m), eta_s.
class CorrectRun {
 public:
  /// `flow` must outlive it; `state` has its shape.
  CorrectRun(const CorrectFlow& flow, CorrectRunConfig config, CorrectState state);

  /// Once. Errors: those of CorrectFlow and of the callbacks; kCancelled, kDeadlineExceeded of
  /// `context`. What was done before the error is in state().
  Status Run(const base::RunContext& context);

  const CorrectState& state() const { return state_; }
  /// Rollouts done. With mutex_ held, or after Run.
  int64_t step() const { return step_; }

  /// What came of one source.
  api::CorrectedClipReport Report(int source) const;

 private:
  /// A piece of work for one thread: a source's zero policy, or a variant.
  struct Unit {
    bool is_variant = false;
    int64_t index = 0;
  };

  void Work();
  std::optional<Unit> NextUnit();
  Status DoZeroPolicy(int source);
  Status DoVariant(int64_t ordinal);
  absl::Time ShareOfTime();
  void ShowRollout(int64_t ordinal, const base::Progress& progress);
  Status Count(int64_t steps);  // with mutex_ held
  void ReportProgress() const;  // with mutex_ held

  const CorrectFlow& flow_;
  const CorrectRunConfig config_;
  base::RunContext context_;
  absl::Time start_;
  double seconds_before_ = 0;
  absl::Time time_up_ = absl::InfiniteFuture();
  int threads_ = 1;

  mutable std::mutex mutex_;
  CorrectState state_;
  std::vector<Unit> units_;  // in the order in which they are begun
  size_t next_unit_ = 0;
  int64_t variants_waiting_ = 0;
  int64_t total_ = 0;
  int64_t step_ = 0;
  int64_t first_step_ = 0;                     // of this attempt
  std::map<int64_t, base::Progress> running_;  // by ordinal
  Status status_;
};

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_CORRECT_RUN_H_
