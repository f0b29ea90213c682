#ifndef POISE_TESTS_CORE_RUNTIME_JOBS_JOB_STORE_FIXTURE_H_
#define POISE_TESTS_CORE_RUNTIME_JOBS_JOB_STORE_FIXTURE_H_

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/runtime/jobs/job_store.h"
#include "tests/support/temporary_folder.h"

/// What every test of a job store needs. The tests are written against JobStore alone; a store
/// joins by instantiating JobStoreTest with its StoreKind.
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
inline void PrintTo(const StoreKind& kind, std::ostream* out) { *out << kind.name; }

class JobStoreTest : public ::testing::TestWithParam<StoreKind> {
 protected:
  /// Opened at the first call, with `policy` as it is then.
  jobs::JobStore& store();
  void CloseStore() { store_.reset(); }

  /// A request for a job of kind "selftest".
  static jobs::NewJob Request(const std::string& request_id = "");

  // Each makes the call, expects OK and returns what it gave.
  std::string Submit(const jobs::NewJob& job = Request());
  api::Job Get(const std::string& id, const std::string& tenant = "default");
  api::Job Cancel(const std::string& id);
  api::JobState Finish(const jobs::Lease& lease, const jobs::Outcome& outcome);
  jobs::HeartbeatReply Heartbeat(const jobs::Lease& lease, int64_t step = 0);
  int64_t Reap();
  std::vector<api::JobEvent> Events(const std::string& id);

  /// The next job for a worker, which is made known first; with a new token.
  std::optional<jobs::Lease> TryClaim(const std::string& worker = "worker-1",
                                      jobs::ClaimQuery query = {});
  /// The same, and there must be one.
  jobs::Lease Claim(const std::string& worker = "worker-1");

  /// "QUEUED RUNNING ...": the states in a job's events, after a check that no change is missing.
  std::string StateHistory(const std::string& id);
  /// Expects that the store finds no fault in itself.
  void ExpectSound();

  jobs::JobPolicy policy_;
  TestClock clock_;
  TemporaryFolder folder_;

 private:
  std::unique_ptr<jobs::JobStore> store_;
  std::atomic<int> tokens_ = 0;
};

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
