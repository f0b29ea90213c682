#ifndef POISE_TESTS_SUPPORT_JOB_CALLS_H_
#define POISE_TESTS_SUPPORT_JOB_CALLS_H_

#include <grpcpp/channel.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "core/api/job.h"
#include "core/base/status.h"
#include "tests/support/job_client.h"

namespace poise::testing {

/// A request for a job of kind "selftest".
api::CreateJob Selftest(const base::Json& parameters, uint64_t seed = 1,
                        const std::string& request_id = "");

/// JobClient with the types of core/api. It does not retry: what answers is what the server said.
/// Threads: all members may be called from any thread.
class JobCalls {
 public:
  explicit JobCalls(std::shared_ptr<grpc::Channel> channel,
                    absl::Duration timeout = absl::Seconds(10))
      : client_(std::move(channel), "", timeout) {}

  StatusOr<api::Job> Create(const api::CreateJob& request) const;
  StatusOr<api::Job> Get(const std::string& id) const;
  StatusOr<api::Job> Cancel(const std::string& id) const;
  /// All pages.
  StatusOr<std::vector<api::Job>> List(const std::string& filter = "") const;
  /// Every event of a terminal job.
  StatusOr<std::vector<api::JobEvent>> Events(const std::string& id) const;

 private:
  const JobClient client_;
};

/// Repeats `call` until it does not end with UNAVAILABLE or DEADLINE_EXCEEDED, or `timeout` is
/// over.
template <typename Call>
auto Persist(Call call, absl::Duration timeout = absl::Seconds(30)) -> decltype(call());

/// Waits until the job's state satisfies `condition`, through outages of the server. The job as it
/// then is; as it was last when the time is over.
api::Job WaitForJob(const JobCalls& calls, const std::string& id,
                    const std::function<bool(const api::Job&)>& condition,
                    absl::Duration timeout = absl::Seconds(60));
/// The same, for its end.
api::Job WaitForEnd(const JobCalls& calls, const std::string& id,
                    absl::Duration timeout = absl::Seconds(60));

/// What is wrong with the whole history of a terminal job, or "": a number missing among its
/// changes, more or less than one terminal event, one that is not the last, attempts that do not
/// fit.
std::string FaultOfHistory(const api::Job& job, const std::vector<api::JobEvent>& events);

template <typename Call>
auto Persist(Call call, absl::Duration timeout) -> decltype(call()) {
  const absl::Time deadline = absl::Now() + timeout;
  for (;;) {
    auto result = call();
    const absl::StatusCode code = result.status().code();
    const bool again =
        code == absl::StatusCode::kUnavailable || code == absl::StatusCode::kDeadlineExceeded;
    if (!again || absl::Now() > deadline) return result;
    absl::SleepFor(absl::Milliseconds(50));
  }
}

}  // namespace poise::testing

#endif  // POISE_TESTS_SUPPORT_JOB_CALLS_H_
