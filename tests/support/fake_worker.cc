#include "tests/support/fake_worker.h"

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "core/base/identifier.h"
#include "google/protobuf/empty.pb.h"
#include "proto/convert/status_convert.h"
#include "proto/convert/time_convert.h"

namespace poise::testing {
namespace {

template <typename Response>
StatusOr<Response> Answer(const grpc::Status& status, Response response) {
  if (!status.ok()) return convert::FromGrpc(status);
  return response;
}

// With a deadline, so that a test that fails ends.
struct Context {
  Context() { value.set_deadline(std::chrono::system_clock::now() + std::chrono::minutes(1)); }
  grpc::ClientContext value;
};

}  // namespace

FakeWorker::FakeWorker(const std::shared_ptr<grpc::Channel>& channel, std::string id)
    : id_(std::move(id)), stub_(v1::WorkerService::NewStub(channel)) {
  v1::RegisterWorkerRequest request;
  request.set_worker(id_);
  request.set_engine("manual");
  request.set_slots(1);
  v1::RegisterWorkerResponse response;
  Context context;
  const grpc::Status status = stub_->RegisterWorker(&context.value, request, &response);
  if (!status.ok()) std::fprintf(stderr, "register: %s\n", status.error_message().c_str());
}

StatusOr<v1::LeaseJobResponse> FakeWorker::Lease(absl::Duration wait,
                                                 v1::LeaseJobRequest request) const {
  request.set_worker(id_);
  if (request.token().empty()) request.set_token(base::RandomHex(16));
  *request.mutable_wait() = convert::ToProto(wait);
  v1::LeaseJobResponse response;
  Context context;
  const grpc::Status status = stub_->LeaseJob(&context.value, request, &response);
  return Answer(status, std::move(response));
}

v1::Lease FakeWorker::MustLease(absl::Duration wait) const {
  const StatusOr<v1::LeaseJobResponse> response = Lease(wait);
  if (!response.ok() || !response->has_lease()) {
    std::fprintf(stderr, "no lease: %s\n", base::Message(response.status()).c_str());
    std::abort();
  }
  return response->lease();
}

StatusOr<v1::HeartbeatResponse> FakeWorker::Heartbeat(const v1::Lease& lease, int64_t step,
                                                      absl::Duration hold) const {
  v1::HeartbeatRequest request;
  *request.mutable_fence() = lease.fence();
  if (step > 0) request.mutable_progress()->set_step(step);
  *request.mutable_hold() = convert::ToProto(hold);
  v1::HeartbeatResponse response;
  Context context;
  const grpc::Status status = stub_->Heartbeat(&context.value, request, &response);
  return Answer(status, std::move(response));
}

Status FakeWorker::Checkpoint(const v1::Lease& lease, const std::string& artifact,
                              int64_t step) const {
  v1::CommitCheckpointRequest request;
  *request.mutable_fence() = lease.fence();
  request.set_artifact(artifact);
  request.set_step(step);
  google::protobuf::Empty empty;
  Context context;
  return convert::FromGrpc(stub_->CommitCheckpoint(&context.value, request, &empty));
}

StatusOr<v1::FinishJobResponse> FakeWorker::Finish(const v1::Lease& lease,
                                                   v1::FinishJobRequest finish) const {
  *finish.mutable_fence() = lease.fence();
  v1::FinishJobResponse response;
  Context context;
  const grpc::Status status = stub_->FinishJob(&context.value, finish, &response);
  return Answer(status, std::move(response));
}

StatusOr<v1::FinishJobResponse> FakeWorker::Fail(const v1::Lease& lease,
                                                 absl::StatusCode code) const {
  v1::FinishJobRequest finish;
  finish.mutable_error()->set_code(static_cast<int>(code));
  finish.mutable_error()->set_reason("AS_ASKED");
  finish.mutable_error()->set_message("the test wanted it");
  return Finish(lease, finish);
}

Status FakeWorker::Release(const v1::Lease& lease) const {
  v1::ReleaseJobRequest request;
  *request.mutable_fence() = lease.fence();
  google::protobuf::Empty empty;
  Context context;
  return convert::FromGrpc(stub_->ReleaseJob(&context.value, request, &empty));
}

}  // namespace poise::testing
