// What Client asks of JobService and AdminService.
#include <fmt/format.h>

#include "absl/time/clock.h"
#include "client/backoff.h"
#include "client/client.h"
#include "client/connection.h"
#include "client/job_watch_stream.h"
#include "core/base/identifier.h"
#include "proto/convert/job_convert.h"

namespace poise::client {
namespace {

constexpr int kRequestIdBytes = 16;

// One unary call, with its answer as a job.
template <typename Request>
StatusOr<api::Job> JobCall(const Connection& connection, const Request& request,
                           grpc::Status (v1::JobService::Stub::*method)(grpc::ClientContext*,
                                                                        const Request&, v1::Job*)) {
  const auto context = connection.NewCall();
  v1::Job job;
  POISE_RETURN_IF_ERROR(
      connection.Explain((connection.job().*method)(context.get(), request, &job)));
  return convert::FromProto(job);
}

Finding::Severity FromProto(v1::DiagnoseResponse::Finding::Severity severity) {
  switch (severity) {
    case v1::DiagnoseResponse::Finding::OK:
      return Finding::Severity::kOk;
    case v1::DiagnoseResponse::Finding::WARNING:
      return Finding::Severity::kWarning;
    default:
      return Finding::Severity::kFault;
  }
}

}  // namespace

StatusOr<api::Job> Client::CreateJob(api::CreateJob request) {
  POISE_RETURN_IF_ERROR(request.Validate());
  if (request.request_id.empty()) request.request_id = base::RandomHex(kRequestIdBytes);
  return JobCall(*connection_, convert::ToProto(request), &v1::JobService::Stub::CreateJob);
}

StatusOr<api::Job> Client::GetJob(const std::string& id) {
  v1::GetJobRequest request;
  request.set_name(convert::JobName(id));
  return JobCall(*connection_, request, &v1::JobService::Stub::GetJob);
}

StatusOr<api::Job> Client::CancelJob(const std::string& id) {
  v1::CancelJobRequest request;
  request.set_name(convert::JobName(id));
  return JobCall(*connection_, request, &v1::JobService::Stub::CancelJob);
}

StatusOr<api::Job> Client::RetryJob(const std::string& id, std::string request_id) {
  v1::RetryJobRequest request;
  request.set_name(convert::JobName(id));
  request.set_request_id(request_id.empty() ? base::RandomHex(kRequestIdBytes)
                                            : std::move(request_id));
  return JobCall(*connection_, request, &v1::JobService::Stub::RetryJob);
}

StatusOr<api::JobPage> Client::ListJobs(const api::JobFilter& filter, int page_size,
                                        const std::string& page_token) {
  v1::ListJobsRequest request;
  request.set_filter(filter.ToString());
  request.set_page_size(page_size);
  request.set_page_token(page_token);
  const auto context = connection_->NewCall();
  v1::ListJobsResponse response;
  POISE_RETURN_IF_ERROR(
      connection_->Explain(connection_->job().ListJobs(context.get(), request, &response)));
  api::JobPage page{.jobs = {}, .next_page_token = response.next_page_token()};
  for (const v1::Job& job : response.jobs()) {
    POISE_ASSIGN_OR_RETURN(api::Job converted, convert::FromProto(job));
    page.jobs.push_back(std::move(converted));
  }
  return page;
}

Status Client::DeleteJob(const std::string& id) {
  v1::DeleteJobRequest request;
  request.set_name(convert::JobName(id));
  Backoff backoff({.outage = connection_->options().outage});
  for (bool again = false;; again = true) {
    const auto context = connection_->NewCall();
    google::protobuf::Empty response;
    const Status status =
        connection_->Explain(connection_->job().DeleteJob(context.get(), request, &response));
    // The first call did it, and its answer was lost.
    if (again && status.code() == absl::StatusCode::kNotFound) return absl::OkStatus();
    if (status.ok()) return status;
    const std::optional<absl::Duration> delay = backoff.Next(status);
    if (!delay) return status;
    connection_->Pause(*delay);
  }
}

std::unique_ptr<JobWatch> Client::WatchJob(const std::string& id, const WatchOptions& options) {
  return std::make_unique<JobWatch>(std::make_unique<JobWatch::Stream>(*connection_, id, options));
}

JobHandle Client::Handle(const std::string& id) { return JobHandle(*this, id); }

StatusOr<std::vector<Finding>> Client::Doctor() {
  const auto context = connection_->NewCall();
  v1::DiagnoseResponse response;
  POISE_RETURN_IF_ERROR(
      connection_->Explain(connection_->admin().Diagnose(context.get(), {}, &response)));
  std::vector<Finding> findings;
  for (const auto& finding : response.findings()) {
    findings.push_back({.severity = FromProto(finding.severity()),
                        .check = finding.check(),
                        .message = finding.message()});
  }
  return findings;
}

StatusOr<StoreBackup> Client::BackUp(const std::string& path) {
  v1::BackUpStoreRequest request;
  request.set_path(path);
  const auto context = connection_->NewCall();
  v1::BackUpStoreResponse response;
  POISE_RETURN_IF_ERROR(
      connection_->Explain(connection_->admin().BackUpStore(context.get(), request, &response)));
  return StoreBackup{.path = response.path(), .size_bytes = response.size_bytes()};
}

}  // namespace poise::client
