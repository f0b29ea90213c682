#include <gtest/gtest.h>

#include <future>

#include "absl/time/clock.h"
#include "google/longrunning/operations.grpc.pb.h"
#include "google/protobuf/empty.pb.h"
#include "google/rpc/error_details.pb.h"
#include "proto/convert/status_convert.h"
#include "proto/convert/time_convert.h"
#include "tests/support/fake_worker.h"
#include "tests/support/job_client.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using google::longrunning::Operation;
using testing::FakeWorker;
using testing::JobClient;
using testing::SelftestRequest;
using testing::TestServer;

class OperationsServiceTest : public ::testing::Test {
 protected:
  StatusOr<Operation> Get(const std::string& name) {
    grpc::ClientContext context;
    google::longrunning::GetOperationRequest request;
    request.set_name(name);
    Operation operation;
    const grpc::Status status = stub_->GetOperation(&context, request, &operation);
    if (!status.ok()) return convert::FromGrpc(status);
    return operation;
  }

  StatusOr<Operation> Wait(const std::string& name, absl::Duration timeout) {
    grpc::ClientContext context;
    google::longrunning::WaitOperationRequest request;
    request.set_name(name);
    *request.mutable_timeout() = convert::ToProto(timeout);
    Operation operation;
    const grpc::Status status = stub_->WaitOperation(&context, request, &operation);
    if (!status.ok()) return convert::FromGrpc(status);
    return operation;
  }

  Status Cancel(const std::string& name) {
    grpc::ClientContext context;
    google::longrunning::CancelOperationRequest request;
    request.set_name(name);
    google::protobuf::Empty empty;
    return convert::FromGrpc(stub_->CancelOperation(&context, request, &empty));
  }

  Status Delete(const std::string& name) {
    grpc::ClientContext context;
    google::longrunning::DeleteOperationRequest request;
    request.set_name(name);
    google::protobuf::Empty empty;
    return convert::FromGrpc(stub_->DeleteOperation(&context, request, &empty));
  }

  StatusOr<google::longrunning::ListOperationsResponse> List(
      const google::longrunning::ListOperationsRequest& request) {
    grpc::ClientContext context;
    google::longrunning::ListOperationsResponse response;
    const grpc::Status status = stub_->ListOperations(&context, request, &response);
    if (!status.ok()) return convert::FromGrpc(status);
    return response;
  }

  TestServer server_;
  JobClient client_{server_.channel()};
  std::unique_ptr<google::longrunning::Operations::Stub> stub_ =
      google::longrunning::Operations::NewStub(server_.channel());
};

TEST_F(OperationsServiceTest, OperationIsTheJob) {
  const std::string name = client_.Create(SelftestRequest())->name();
  const StatusOr<Operation> running = Get(name);
  ASSERT_TRUE(running.ok()) << running.status();
  EXPECT_EQ(running->name(), name);
  EXPECT_FALSE(running->done());
  v1::Job job;
  ASSERT_TRUE(running->metadata().UnpackTo(&job));
  EXPECT_EQ(job.SerializeAsString(), client_.Get(name)->SerializeAsString());
  const FakeWorker worker(server_.channel());
  ASSERT_TRUE(worker.Finish(worker.MustLease()).ok());
  const StatusOr<Operation> done = Get(name);
  EXPECT_TRUE(done->done());
  ASSERT_TRUE(done->response().UnpackTo(&job));
  EXPECT_EQ(job.state(), v1::Job::SUCCEEDED);
}

TEST_F(OperationsServiceTest, FailedJobIsAnErrorWithItsDetails) {
  const std::string name = client_.Create(SelftestRequest())->name();
  const FakeWorker worker(server_.channel());
  ASSERT_TRUE(worker.Fail(worker.MustLease(), absl::StatusCode::kOutOfRange).ok());
  const StatusOr<Operation> failed = Get(name);
  EXPECT_TRUE(failed->done());
  EXPECT_EQ(failed->error().code(), static_cast<int>(absl::StatusCode::kOutOfRange));
  EXPECT_EQ(failed->error().message(), "the test wanted it");
  google::rpc::ErrorInfo info;
  ASSERT_TRUE(failed->error().details(0).UnpackTo(&info));
  EXPECT_EQ(info.reason(), "AS_ASKED");
}

TEST_F(OperationsServiceTest, CancelledOperationCarriesTheCodeOfThatNameAndCanBeDeleted) {
  const std::string name = client_.Create(SelftestRequest())->name();
  EXPECT_EQ(base::ErrorReason(Delete(name)), "JOB_NOT_TERMINAL");
  ASSERT_TRUE(Cancel(name).ok());
  EXPECT_EQ(Get(name)->error().code(), 1);
  EXPECT_TRUE(Delete(name).ok());
  EXPECT_EQ(base::ErrorReason(Get(name).status()), "JOB_NOT_FOUND");
  EXPECT_EQ(base::ErrorReason(Cancel(name)), "JOB_NOT_FOUND");
}

TEST_F(OperationsServiceTest, ListIsPagedAndFiltered) {
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(client_.Create(SelftestRequest()).ok());
  google::longrunning::ListOperationsRequest request;
  request.set_name("jobs");
  request.set_page_size(2);
  const auto first = List(request);
  ASSERT_TRUE(first.ok()) << first.status();
  EXPECT_EQ(first->operations_size(), 2);
  request.set_page_token(first->next_page_token());
  EXPECT_EQ(List(request)->operations_size(), 1);
  request.clear_page_token();
  request.set_filter("state=FAILED");
  EXPECT_EQ(List(request)->operations_size(), 0);
  request.set_name("somewhere/else");
  EXPECT_EQ(base::ErrorReason(List(request).status()), "BAD_JOB_NAME");
}

TEST_F(OperationsServiceTest, WaitEndsWithTheJobOrWithItsTimeout) {
  const std::string name = client_.Create(SelftestRequest())->name();
  EXPECT_FALSE(Wait(name, absl::Milliseconds(100))->done());
  auto waiting = std::async(std::launch::async, [&] { return Wait(name, absl::Seconds(60)); });
  while (server_.server().calls() < 1) absl::SleepFor(absl::Milliseconds(1));
  const FakeWorker worker(server_.channel());
  const v1::Lease lease = worker.MustLease();
  EXPECT_EQ(waiting.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  ASSERT_TRUE(worker.Finish(lease).ok());
  EXPECT_TRUE(waiting.get()->done());
  EXPECT_TRUE(Wait(name, absl::Seconds(60))->done());
  EXPECT_EQ(base::ErrorReason(Wait("jobs/x", absl::Seconds(1)).status()), "JOB_NOT_FOUND");
}

}  // namespace
}  // namespace poise::server
