#include "server/handlers/operations_handler.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "absl/time/clock.h"
#include "google/protobuf/empty.pb.h"
#include "proto/convert/job_convert.h"
#include "proto/convert/status_convert.h"
#include "proto/convert/time_convert.h"
#include "server/handlers/job_pages.h"

namespace poise::server {
namespace {

namespace longrunning = google::longrunning;
using google::protobuf::Empty;

longrunning::Operation OperationOf(const v1::Job& job) {
  longrunning::Operation operation;
  operation.set_name(job.name());
  operation.mutable_metadata()->PackFrom(job);
  if (job.state() == v1::Job::SUCCEEDED) {
    operation.set_done(true);
    operation.mutable_response()->PackFrom(job);
  } else if (job.state() == v1::Job::FAILED || job.state() == v1::Job::CANCELLED) {
    operation.set_done(true);
    // With the same details as an error of a call.
    operation.mutable_error()->ParseFromString(
        convert::ToGrpc(convert::FromProto(job.error()).ToStatus()).error_details());
  }
  return operation;
}

Status CheckParent(const std::string& name) {
  if (name.empty() || name == "jobs") return absl::OkStatus();
  return base::InvalidArgument("BAD_JOB_NAME", "name",
                               "operations are listed under the name 'jobs'");
}

// A client that waits for the end of a job.
class WaitCall : public UnaryCall {
 public:
  WaitCall(Setup setup, grpc::ByteBuffer request, engine::JobManager& jobs, const DrainState& drain)
      : UnaryCall(std::move(setup)), request_(std::move(request)), jobs_(jobs), drain_(drain) {}

 private:
  Answer Try() override {
    if (job_.empty()) POISE_RETURN_IF_ERROR(Begin());
    POISE_ASSIGN_OR_RETURN(const api::Job job, jobs_.Get(call().tenant(), job_));
    if (!api::IsTerminal(job.state) && absl::Now() < end_ && !drain_.ending) return std::nullopt;
    return Serialize(OperationOf(convert::ToProto(job)));
  }

  Status Begin() {
    // The state at the end of the wait is an answer, a deadline that passed is none.
    constexpr absl::Duration kMargin = absl::Milliseconds(200);
    POISE_ASSIGN_OR_RETURN(const auto request,
                           Parse<longrunning::WaitOperationRequest>(std::move(request_)));
    POISE_ASSIGN_OR_RETURN(job_, convert::JobId(request.name()));
    end_ = call().run().deadline - kMargin;
    if (request.has_timeout()) {
      end_ = std::min(end_, absl::Now() + convert::FromProto(request.timeout()));
    }
    subscription_ = jobs_.transitions().Subscribe(job_, [weak = weak_from_this()] {
      if (auto self = weak.lock()) self->Wake();
    });
    WakeAt(end_);
    return absl::OkStatus();
  }

  void OnEnded() override { subscription_.reset(); }

  grpc::ByteBuffer request_;
  engine::JobManager& jobs_;
  const DrainState& drain_;
  std::string job_;  // id
  absl::Time end_;
  std::unique_ptr<engine::EventHub::Subscription> subscription_;
};

}  // namespace

OperationsHandler::OperationsHandler(engine::JobManager& jobs, base::ThreadPool& pool,
                                     Admission& admission, const MethodPolicies& policies,
                                     const DrainState& drain)
    : jobs_(jobs), policies_(policies), drain_(drain), unary_(admission, pool) {}

grpc::ServerUnaryReactor* OperationsHandler::GetOperation(grpc::CallbackServerContext* context,
                                                          const grpc::ByteBuffer* request,
                                                          grpc::ByteBuffer* response) {
  return unary_.Answer<longrunning::GetOperationRequest>(
      {context, request, response}, policies_.job,
      [this](const longrunning::GetOperationRequest& message,
             const Call& call) -> StatusOr<longrunning::Operation> {
        POISE_ASSIGN_OR_RETURN(const std::string id, convert::JobId(message.name()));
        POISE_ASSIGN_OR_RETURN(const api::Job job, jobs_.Get(call.tenant(), id));
        return OperationOf(convert::ToProto(job));
      });
}

grpc::ServerUnaryReactor* OperationsHandler::ListOperations(grpc::CallbackServerContext* context,
                                                            const grpc::ByteBuffer* request,
                                                            grpc::ByteBuffer* response) {
  return unary_.Answer<longrunning::ListOperationsRequest>(
      {context, request, response}, policies_.job,
      [this](const longrunning::ListOperationsRequest& message,
             const Call& call) -> StatusOr<longrunning::ListOperationsResponse> {
        POISE_RETURN_IF_ERROR(CheckParent(message.name()));
        POISE_ASSIGN_OR_RETURN(api::JobFilter filter, api::JobFilter::Parse(message.filter()));
        POISE_ASSIGN_OR_RETURN(v1::ListJobsResponse page,
                               ListPage(jobs_, {.tenant = call.tenant(),
                                                .filter = std::move(filter),
                                                .page_size = message.page_size(),
                                                .page_token = message.page_token()}));
        longrunning::ListOperationsResponse answer;
        for (const v1::Job& job : page.jobs()) *answer.add_operations() = OperationOf(job);
        answer.set_next_page_token(page.next_page_token());
        return answer;
      });
}

grpc::ServerUnaryReactor* OperationsHandler::CancelOperation(grpc::CallbackServerContext* context,
                                                             const grpc::ByteBuffer* request,
                                                             grpc::ByteBuffer* response) {
  return unary_.Answer<longrunning::CancelOperationRequest>(
      {context, request, response}, policies_.job,
      [this](const longrunning::CancelOperationRequest& message,
             const Call& call) -> StatusOr<Empty> {
        POISE_ASSIGN_OR_RETURN(const std::string id, convert::JobId(message.name()));
        POISE_RETURN_IF_ERROR(jobs_.Cancel(call.tenant(), id, call.origin().peer).status());
        return Empty();
      });
}

grpc::ServerUnaryReactor* OperationsHandler::DeleteOperation(grpc::CallbackServerContext* context,
                                                             const grpc::ByteBuffer* request,
                                                             grpc::ByteBuffer* response) {
  return unary_.Answer<longrunning::DeleteOperationRequest>(
      {context, request, response}, policies_.job,
      [this](const longrunning::DeleteOperationRequest& message,
             const Call& call) -> StatusOr<Empty> {
        POISE_ASSIGN_OR_RETURN(const std::string id, convert::JobId(message.name()));
        POISE_RETURN_IF_ERROR(jobs_.Delete(call.tenant(), id));
        return Empty();
      });
}

grpc::ServerUnaryReactor* OperationsHandler::WaitOperation(grpc::CallbackServerContext* context,
                                                           const grpc::ByteBuffer* request,
                                                           grpc::ByteBuffer* response) {
  return unary_.Start<WaitCall>({context, request, response}, policies_.wait_operation, jobs_,
                                drain_);
}

}  // namespace poise::server
