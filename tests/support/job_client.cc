#include "tests/support/job_client.h"

#include <utility>

#include "absl/time/clock.h"
#include "google/protobuf/empty.pb.h"
#include "proto/convert/status_convert.h"

namespace poise::testing {
namespace {

template <typename Response>
StatusOr<Response> Answer(const grpc::Status& status, Response response) {
  if (!status.ok()) return convert::FromGrpc(status);
  return response;
}

}  // namespace

JobClient::JobClient(std::shared_ptr<grpc::Channel> channel, std::string tenant,
                     absl::Duration timeout)
    : tenant_(std::move(tenant)),
      timeout_(timeout),
      stub_(v1::JobService::NewStub(std::move(channel))) {}

std::unique_ptr<grpc::ClientContext> JobClient::NewContext() const {
  auto context = std::make_unique<grpc::ClientContext>();
  context->set_deadline(absl::ToChronoTime(absl::Now() + timeout_));
  if (!tenant_.empty()) context->AddMetadata("x-poise-tenant", tenant_);
  return context;
}

StatusOr<v1::Job> JobClient::Create(const v1::CreateJobRequest& request) const {
  v1::Job job;
  const grpc::Status status = stub_->CreateJob(NewContext().get(), request, &job);
  return Answer(status, std::move(job));
}

StatusOr<v1::Job> JobClient::Get(const std::string& name) const {
  v1::GetJobRequest request;
  request.set_name(name);
  v1::Job job;
  const grpc::Status status = stub_->GetJob(NewContext().get(), request, &job);
  return Answer(status, std::move(job));
}

StatusOr<v1::ListJobsResponse> JobClient::List(const v1::ListJobsRequest& request) const {
  v1::ListJobsResponse response;
  const grpc::Status status = stub_->ListJobs(NewContext().get(), request, &response);
  return Answer(status, std::move(response));
}

StatusOr<v1::Job> JobClient::Cancel(const std::string& name) const {
  v1::CancelJobRequest request;
  request.set_name(name);
  v1::Job job;
  const grpc::Status status = stub_->CancelJob(NewContext().get(), request, &job);
  return Answer(status, std::move(job));
}

Status JobClient::Delete(const std::string& name) const {
  v1::DeleteJobRequest request;
  request.set_name(name);
  google::protobuf::Empty empty;
  return convert::FromGrpc(stub_->DeleteJob(NewContext().get(), request, &empty));
}

StatusOr<v1::Job> JobClient::Retry(const std::string& name, const std::string& request_id) const {
  v1::RetryJobRequest request;
  request.set_name(name);
  request.set_request_id(request_id);
  v1::Job job;
  const grpc::Status status = stub_->RetryJob(NewContext().get(), request, &job);
  return Answer(status, std::move(job));
}

StatusOr<std::vector<v1::JobResultChunk>> JobClient::Result(const std::string& name,
                                                            const std::string& artifact) const {
  v1::GetJobResultRequest request;
  request.set_name(name);
  request.set_artifact(artifact);
  const auto context = NewContext();
  const auto reader = stub_->GetJobResult(context.get(), request);
  std::vector<v1::JobResultChunk> chunks;
  for (v1::JobResultChunk chunk; reader->Read(&chunk);) chunks.push_back(chunk);
  return Answer(reader->Finish(), std::move(chunks));
}

Status JobClient::Watch(const std::string& name, int64_t after_seq,
                        const std::function<void(const v1::WatchJobResponse&)>& on_message) const {
  v1::WatchJobRequest request;
  request.set_name(name);
  request.set_after_seq(after_seq);
  const auto context = NewContext();
  const auto reader = stub_->WatchJob(context.get(), request);
  for (v1::WatchJobResponse message; reader->Read(&message);) {
    if (on_message) on_message(message);
  }
  return convert::FromGrpc(reader->Finish());
}

v1::CreateJobRequest SelftestRequest(const std::string& request_id) {
  v1::CreateJobRequest request;
  request.mutable_spec()->set_kind("selftest");
  request.set_request_id(request_id);
  return request;
}

}  // namespace poise::testing
