#ifndef POISE_TESTS_CORE_RUNTIME_JOBS_JOB_MODEL_H_
#define POISE_TESTS_CORE_RUNTIME_JOBS_JOB_MODEL_H_

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/runtime/jobs/job_store.h"

namespace poise::testing {

/// What jobs may do, kept in memory beside a store: it hears every change that the store announces
/// and every answer that a caller got, and says what does not fit together.
/// Threads: all members may be called from any thread.
class JobModel {
 public:
  /// What the store announced.
  void OnTransition(const jobs::Transition& change);

  // What callers were answered.
  void OnSubmitted(const std::string& request_id, const std::string& id);
  void OnClaimed(const jobs::Fence& fence);
  void OnSuccess(const jobs::Fence& fence);
  void OnDeleted(const std::string& id);

  /// Compares with the store, which nobody uses now and in which every job has ended.
  void CheckAtTheEnd(jobs::JobStore& store);

  /// Empty: everything fits.
  std::vector<std::string> faults();
  int64_t jobs();
  int64_t transitions();

 private:
  struct Known {
    std::optional<api::JobState> state;
    int attempt = 0;
    std::string states;  // "QUEUED RUNNING ..."
    std::set<int> claimed, succeeded;
  };

  void Check(const std::string& id, const Known& known, const api::Job& job,
             const std::vector<api::JobEvent>& events);
  void Expect(bool fits, const std::string& id, const std::string& what);

  std::mutex mutex_;
  std::map<std::string, Known> jobs_;
  std::map<std::string, std::set<std::string>> requests_;  // ids that each was answered
  std::set<std::string> deleted_;
  int64_t transitions_ = 0;
  std::vector<std::string> faults_;
};

}  // namespace poise::testing

#endif  // POISE_TESTS_CORE_RUNTIME_JOBS_JOB_MODEL_H_
