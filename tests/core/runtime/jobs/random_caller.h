#ifndef POISE_TESTS_CORE_RUNTIME_JOBS_RANDOM_CALLER_H_
#define POISE_TESTS_CORE_RUNTIME_JOBS_RANDOM_CALLER_H_

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "tests/core/runtime/jobs/job_model.h"
#include "tests/core/runtime/jobs/job_store_fixture.h"

namespace poise::testing {

/// A client and a worker in one that calls a store at random and tells the model what it was
/// answered. It remembers the leases it had, and goes on writing with them long after they ended.
class RandomCaller {
 public:
  /// The same seed draws the same calls.
  RandomCaller(jobs::JobStore& store, TestClock& clock, const jobs::JobPolicy& policy,
               JobModel& model, int index, uint64_t seed);

  void CallOnce();
  int64_t lease_lost() const { return lease_lost_; }

 private:
  struct Held {
    jobs::Fence fence;
    int64_t step = 0;
  };

  void Submit();
  void Claim();
  void Finish();
  void Checkpoint();
  void Heartbeat();
  void Release();
  void CancelOrDelete();
  void Read();
  void KeepHouse();

  jobs::Outcome DrawOutcome();
  // A lease it has or had; nullptr before the first.
  Held* Draw();
  // Any error but a lost lease is a fault of the store.
  void Note(const Status& status);

  jobs::JobStore& store_;
  TestClock& clock_;
  const jobs::JobPolicy policy_;
  JobModel& model_;
  const std::string worker_;
  base::Random random_;
  std::vector<Held> held_;
  std::vector<std::string> jobs_;
  int64_t tokens_ = 0;
  int64_t lease_lost_ = 0;
};

}  // namespace poise::testing

#endif  // POISE_TESTS_CORE_RUNTIME_JOBS_RANDOM_CALLER_H_
