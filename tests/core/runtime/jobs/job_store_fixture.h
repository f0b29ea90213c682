#ifndef POISE_TESTS_CORE_RUNTIME_JOBS_JOB_STORE_FIXTURE_H_
#define POISE_TESTS_CORE_RUNTIME_JOBS_JOB_STORE_FIXTURE_H_

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/runtime/jobs/job_store.h"
#include "tests/support/temporary_folder.h"

/// What every test of a job store needs. The tests are written against JobStore alone, each file
/// about one subject; a store joins them all by its line in StoreKinds().
namespace poise::testing {

/// A clock that stands still until it is told to go on. Threads: any.
class TestClock {
 public:
  absl::Time Now() const { return absl::FromUnixMillis(milliseconds_); }
  void Advance(absl::Duration by) { milliseconds_ += absl::ToInt64Milliseconds(by); }

 private:
  std::atomic<int64_t> milliseconds_ = 1'800'000'000'000;
};

struct StoreKind {
  const char* name;
  StatusOr<std::unique_ptr<jobs::JobStore>> (*open)(const std::filesystem::path& folder,
                                                    const jobs::JobPolicy& policy,
                                                    std::function<absl::Time()> clock);
};
/// store_kinds.cc: INSTANTIATE_TEST_SUITE_P(Stores, X, ValuesIn(StoreKinds()), NameOfKind).
const std::vector<StoreKind>& StoreKinds();
std::string NameOfKind(const ::testing::TestParamInfo<StoreKind>& info);
inline void PrintTo(const StoreKind& kind, std::ostream* out) { *out << kind.name; }

class JobStoreTest : public ::testing::TestWithParam<StoreKind> {
 protected:
  /// Opened at the first call, with `policy` as it is then.
  jobs::JobStore& store();
  void CloseStore() { store_.reset(); }

  /// A request for a job of kind "selftest".
  static jobs::NewJob Request(const std::string& request_id = "");
  static jobs::NewJob RequestOf(const std::string& tenant);

  // Each makes the call, expects OK and returns what it gave.
  std::string Submit(const jobs::NewJob& job = Request());
  /// `count` times the same, from several threads.
  void SubmitMany(const jobs::NewJob& job, int count);
  api::Job Get(const std::string& id, const std::string& tenant = "default");
  api::Job Cancel(const std::string& id);
  api::JobState Finish(const jobs::Lease& lease, const jobs::Outcome& outcome);
  jobs::HeartbeatReply Heartbeat(const jobs::Lease& lease, int64_t step = 0);
  void Checkpoint(const jobs::Lease& lease, int64_t step);
  void Release(const jobs::Lease& lease);
  int64_t Reap();
  /// The worker of every lease dies and is noticed.
  void LoseAllWorkers();
  std::vector<api::JobEvent> Events(const std::string& id);

  /// The next job for a worker, which is made known first; with a new token.
  std::optional<jobs::Lease> TryClaim(const std::string& worker = "worker-1",
                                      jobs::ClaimQuery query = {});
  /// The same, and there must be one.
  jobs::Lease Claim(const std::string& worker = "worker-1");
  /// Makes a job known, claims it and ends its attempt; returns its id.
  std::string RunJob(const jobs::Outcome& outcome);

  /// "QUEUED RUNNING ...": the states in a job's events, after a check that no change is missing.
  std::string StateHistory(const std::string& id);
  /// Expects that the store finds no fault in itself.
  void ExpectSound();
  /// What the listener was told since the store was opened.
  std::vector<jobs::Transition> Transitions();

  jobs::JobPolicy policy_;
  TestClock clock_;
  TemporaryFolder folder_;

 private:
  std::mutex mutex_;
  std::vector<jobs::Transition> transitions_;
  std::unique_ptr<jobs::JobStore> store_;
  std::atomic<int> tokens_ = 0;
};

/// Calls `work(i)` for i = 0 .. count - 1, each on a thread of its own, all begun at once.
void InParallel(int count, const std::function<void(int)>& work);

/// "artifacts/" and 64 times the digit.
std::string ArtifactName(char digit);

// Ways in which an attempt ends.
jobs::Outcome Success();
jobs::Outcome ErrorWith(absl::StatusCode code);
jobs::Outcome EndedAs(api::AttemptOutcome outcome);

/// Reason of an error, "" when it is OK.
std::string ReasonOf(const Status& status);
template <typename T>
std::string ReasonOf(const StatusOr<T>& value) {
  return ReasonOf(value.status());
}

}  // namespace poise::testing

#endif  // POISE_TESTS_CORE_RUNTIME_JOBS_JOB_STORE_FIXTURE_H_
