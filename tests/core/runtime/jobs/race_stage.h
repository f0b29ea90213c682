#ifndef POISE_TESTS_CORE_RUNTIME_JOBS_RACE_STAGE_H_
#define POISE_TESTS_CORE_RUNTIME_JOBS_RACE_STAGE_H_

#include <optional>
#include <string>
#include <vector>

#include "tests/core/runtime/jobs/held_call.h"
#include "tests/core/runtime/jobs/job_store_fixture.h"

namespace poise::testing {

/// A store, its clock, and the promises that were seen broken. Unlike a test it expects nothing:
/// with a store that lacks its fence promises must break.
class RaceStage {
 public:
  RaceStage(jobs::JobStore& store, TestClock& clock, const jobs::JobPolicy& policy)
      : store_(store), clock_(clock), policy_(policy) {}

  jobs::JobStore& store() { return store_; }

  /// A fresh job, the only one that is claimable.
  std::string Submit(absl::Duration deadline = absl::InfiniteDuration());
  /// nullopt when there was none.
  std::optional<jobs::Lease> TryClaim(const std::string& worker, const std::string& token);
  jobs::Lease Claim(const std::string& worker);
  /// All leases end because their workers were silent.
  void ReapSilentWorkers();
  /// Time goes on, and the reaper ends what is due.
  void ReapAfter(absl::Duration time);

  // Held just before they take effect.
  HeldCall<StatusOr<api::JobState>> HeldFinish(const jobs::Fence& fence,
                                               const jobs::Outcome& outcome);
  HeldCall<Status> HeldCheckpoint(const jobs::Fence& fence, char digit, int64_t step);
  HeldCall<StatusOr<jobs::HeartbeatReply>> HeldHeartbeat(const jobs::Fence& fence, int64_t step);
  HeldCall<Status> HeldRelease(const jobs::Fence& fence);
  HeldCall<Status> HeldCancel(const std::string& id);
  HeldCall<StatusOr<int64_t>> HeldReap();
  HeldCall<std::optional<jobs::Lease>> HeldClaim(const std::string& worker);

  void Promise(bool held, const std::string& what);
  /// `status` refuses a stale worker.
  void PromiseLeaseLost(const Status& status, const std::string& who);
  void PromiseState(const std::string& id, api::JobState state);
  api::Job Get(const std::string& id);
  /// Of any job at any time: no change is missing in its events, it ended at most once, and its
  /// attempts say the same as its state.
  void PromiseSoundStory(const std::string& id);

  const std::vector<std::string>& broken() const { return broken_; }

 private:
  jobs::JobStore& store_;
  TestClock& clock_;
  const jobs::JobPolicy policy_;
  std::vector<std::string> broken_;
};

/// An outcome that tells itself apart from others by its artifact.
jobs::Outcome SuccessWith(char digit);

}  // namespace poise::testing

#endif  // POISE_TESTS_CORE_RUNTIME_JOBS_RACE_STAGE_H_
