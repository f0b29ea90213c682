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
  std::vector<LearnedPolicy> policies;                              // (sources)
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
/// shared: no variant takes so much that a later one gets none. With the effort `full` the sources
/// come one after the other: first their policy, with all threads, then their variants.
/// Progress: step counts samples, which are simulated frames, or actions that a policy learned
/// from; the metrics samples, reward (normalised), force (mean, body weights), torque (mean, N m),
/// eta_s.
class CorrectRun {
 public:
  /// `flow` must outlive it; `state` has its shape.
  CorrectRun(CorrectFlow& flow, CorrectRunConfig config, CorrectState state);

  /// Once. Errors: those of CorrectFlow and of the callbacks; kCancelled, kDeadlineExceeded of
  /// `context`. What was done before the error is in state().
  Status Run(const base::RunContext& context);

  const CorrectState& state() const { return state_; }
  /// Samples done. After Run.
  int64_t step() const { return step_; }

  /// What came of one source.
  api::CorrectedClipReport Report(int source) const;

 private:
  /// A piece of work for one thread: a source's zero policy, or a variant.
  struct Unit {
    bool is_variant = false;
    int64_t index = 0;
  };

  /// All that is not done of the sources from `first` to before `last`.
  Status RunSources(int first, int last, absl::Time time_up);
  Status Learn(int source);
  void Work();
  std::optional<Unit> NextUnit();
  Status DoZeroPolicy(int source);
  Status DoVariant(int64_t ordinal);
  absl::Time ShareOfTime();
  void ShowRollout(int64_t ordinal, const base::Progress& progress);
  Status Count(int64_t steps);  // with mutex_ held
  int64_t StepsOf(const Unit& unit) const;
  void ReportProgress() const;  // with mutex_ held

  CorrectFlow& flow_;
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
  size_t end_unit_ = 0;  // of the sources that are worked on
  int64_t variants_waiting_ = 0;
  int64_t total_ = 0;
  int64_t step_ = 0;
  int64_t first_step_ = 0;  // of this attempt
  struct Running {
    int64_t samples = 0;
    base::Progress progress;
  };
  std::map<int64_t, Running> running_;      // variants by ordinal
  std::optional<base::Progress> learning_;  // of the policy that is learned
  Status status_;
};

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_CORRECT_RUN_H_
