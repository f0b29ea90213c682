#ifndef POISE_TESTS_SUPPORT_JOB_CLIENT_H_
#define POISE_TESTS_SUPPORT_JOB_CLIENT_H_

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "core/base/status.h"
#include "poise/v1/job_service.grpc.pb.h"

namespace poise::testing {

/// poise.v1.JobService as a test calls it: one call each, with a deadline.
class JobClient {
 public:
  explicit JobClient(std::shared_ptr<grpc::Channel> channel, std::string tenant = "",
                     absl::Duration timeout = absl::Minutes(1));

  StatusOr<v1::Job> Create(const v1::CreateJobRequest& request) const;
  StatusOr<v1::Job> Get(const std::string& name) const;
  StatusOr<v1::ListJobsResponse> List(const v1::ListJobsRequest& request) const;
  StatusOr<v1::Job> Cancel(const std::string& name) const;
  Status Delete(const std::string& name) const;
  StatusOr<v1::Job> Retry(const std::string& name, const std::string& request_id = "") const;
  /// The chunks, in order.
  StatusOr<std::vector<v1::JobResultChunk>> Result(const std::string& name,
                                                   const std::string& artifact = "") const;
  /// Watches to the end of the stream; `on_message` may be empty.
  Status Watch(const std::string& name, int64_t after_seq,
               const std::function<void(const v1::WatchJobResponse&)>& on_message) const;

  std::unique_ptr<grpc::ClientContext> NewContext() const;
  v1::JobService::Stub& stub() const { return *stub_; }

 private:
  const std::string tenant_;
  const absl::Duration timeout_;
  std::unique_ptr<v1::JobService::Stub> stub_;
};

/// A request for a job of kind "selftest".
v1::CreateJobRequest SelftestRequest(const std::string& request_id = "");

}  // namespace poise::testing

#endif  // POISE_TESTS_SUPPORT_JOB_CLIENT_H_
