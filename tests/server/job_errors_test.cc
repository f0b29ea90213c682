// Every error of the job services has its details, and every reason that docs/server.md lists for
// them is produced here.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include "google/longrunning/operations.grpc.pb.h"
#include "google/protobuf/empty.pb.h"
#include "poise/v1/admin_service.grpc.pb.h"
#include "tests/support/fake_worker.h"
#include "tests/support/job_client.h"
#include "tests/support/raw_call.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using testing::FakeWorker;
using testing::JobClient;
using testing::SelftestRequest;
using testing::TestServer;

// What came of a wrong call.
struct Refused {
  grpc::StatusCode code;
  std::string reason;
};

class JobErrorsTest : public ::testing::Test {
 protected:
  static engine::JobManagerConfig Config() {
    engine::JobManagerConfig config;
    config.policy.max_queued_per_tenant = 4;
    config.policy.max_unfinished = 6;
    return config;
  }

  // Calls a method with a message, expects an error with all its details and remembers the reason.
  Refused Call(const std::string& method, const google::protobuf::Message& message) {
    return CallBytes(method, message.SerializeAsString());
  }
  Refused CallBytes(const std::string& method, const std::string& bytes) {
    const grpc::Status status = testing::RawCall(server_.channel(), "/" + method, bytes, 4);
    const google::rpc::ErrorInfo info = testing::ErrorInfoOf(status);
    EXPECT_FALSE(status.ok()) << method;
    EXPECT_EQ(info.domain(), "poise.dev") << method << ": " << status.error_message();
    EXPECT_FALSE(info.reason().empty()) << method;
    produced_.insert(info.reason());
    return {status.error_code(), info.reason()};
  }
  void Remember(const Status& status) { produced_.insert(base::ErrorReason(status)); }

  Refused Create(const std::function<void(v1::CreateJobRequest&)>& change) {
    v1::CreateJobRequest request = SelftestRequest();
    change(request);
    return Call("poise.v1.JobService/CreateJob", request);
  }
  Refused List(const std::function<void(v1::ListJobsRequest&)>& change) {
    v1::ListJobsRequest request;
    change(request);
    return Call("poise.v1.JobService/ListJobs", request);
  }
  Refused Finish(const v1::Lease& lease, const std::function<void(v1::FinishJobRequest&)>& change) {
    v1::FinishJobRequest request;
    *request.mutable_fence() = lease.fence();
    change(request);
    return Call("poise.v1.WorkerService/FinishJob", request);
  }
  Refused BackUp(const std::string& path) {
    v1::BackUpStoreRequest request;
    request.set_path(path);
    return Call("poise.v1.AdminService/BackUpStore", request);
  }

  void ProduceOfJobs();
  void ProduceOfStates();
  void ProduceOfWorkers();
  void ProduceOfLimits();

  TestServer server_{{}, 1, Config()};
  JobClient client_{server_.channel()};
  std::set<std::string> produced_;
};

void JobErrorsTest::ProduceOfJobs() {
  Create([](auto& r) { r.mutable_spec()->set_kind("juggle"); });
  const auto parameter = [](auto& r, const char* name) -> google::protobuf::Value& {
    return (*r.mutable_spec()->mutable_parameters()->mutable_fields())[name];
  };
  Create([&](auto& r) { parameter(r, "stepz").set_number_value(1); });
  Create([&](auto& r) { parameter(r, "steps").set_number_value(-1); });
  Create([&](auto& r) { parameter(r, "steps").set_string_value("many"); });
  Create([&](auto& r) { parameter(r, "steps").set_number_value(std::nan("")); });
  Create([&](auto& r) { parameter(r, "x").set_string_value(std::string(300'000, 'x')); });
  Create([](auto& r) { r.set_request_id("a b"); });
  Create([](auto& r) { r.set_queue("a/b"); });
  Create([](auto& r) { r.set_priority(-11); });
  Create([](auto& r) { r.mutable_limits()->set_max_errors(-1); });
  Create([](auto& r) { (*r.mutable_labels())[""] = "x"; });
  Create([](auto& r) {
    for (int i = 0; i < 65; ++i) (*r.mutable_labels())["k" + std::to_string(i)] = "x";
  });
  List([](auto& r) { r.set_page_size(-1); });
  List([](auto& r) { r.set_page_token("nonsense"); });
  List([](auto& r) { r.set_filter("colour=red"); });
  List([](auto& r) { r.set_filter("state=ASLEEP"); });
  Remember(JobClient(server_.channel(), "a/b").Get("jobs/x").status());
}

void JobErrorsTest::ProduceOfStates() {
  v1::GetJobRequest get;
  get.set_name("jobs/nobody");
  EXPECT_EQ(Call("poise.v1.JobService/GetJob", get).code, grpc::StatusCode::NOT_FOUND);
  get.set_name("nobody");
  Call("poise.v1.JobService/GetJob", get);
  const std::string name = client_.Create(SelftestRequest("r1"))->name();
  Create([](auto& r) {
    r.set_request_id("r1");
    r.set_seed(1);
  });
  v1::DeleteJobRequest remove;
  remove.set_name(name);
  Call("poise.v1.JobService/DeleteJob", remove);
  v1::GetJobResultRequest result;
  result.set_name(name);
  Call("poise.v1.JobService/GetJobResult", result);
  v1::RetryJobRequest retry;
  retry.set_name(name);
  Call("poise.v1.JobService/RetryJob", retry);
  ASSERT_TRUE(client_.Cancel(name).ok());
}

void JobErrorsTest::ProduceOfWorkers() {
  Call("poise.v1.WorkerService/RegisterWorker", v1::RegisterWorkerRequest());
  v1::LeaseJobRequest lease_request;
  lease_request.set_worker("nobody");
  Call("poise.v1.WorkerService/LeaseJob", lease_request);
  lease_request.set_token("0123456789abcdef");
  Call("poise.v1.WorkerService/LeaseJob", lease_request);
  for (int i = 0; i < 65; ++i) lease_request.add_kinds("k");
  Call("poise.v1.WorkerService/LeaseJob", lease_request);
  ASSERT_TRUE(client_.Create(SelftestRequest()).ok());
  const FakeWorker worker(server_.channel());
  const v1::Lease lease = worker.MustLease();
  Finish(lease, [](auto& r) { r.set_outcome(v1::JobAttempt::RELEASED); });
  Finish(lease, [](auto& r) { r.set_outcome(static_cast<v1::JobAttempt::Outcome>(99)); });
  Finish(lease, [](auto& r) { r.add_artifacts()->set_name("/x"); });
  Finish(lease, [](auto& r) {
    r.add_artifacts()->set_name("x");
    r.mutable_artifacts(0)->set_artifact("artifacts/" + std::string(64, 'a'));
  });
  Finish(lease, [](auto& r) {
    for (int i = 0; i < 10'001; ++i) r.add_artifacts()->set_name("x");
  });
  v1::CommitCheckpointRequest checkpoint;
  *checkpoint.mutable_fence() = lease.fence();
  checkpoint.set_artifact("x");
  Call("poise.v1.WorkerService/CommitCheckpoint", checkpoint);
  ASSERT_TRUE(worker.Finish(lease).ok());
  v1::HeartbeatRequest heartbeat;
  *heartbeat.mutable_fence() = lease.fence();
  EXPECT_EQ(Call("poise.v1.WorkerService/Heartbeat", heartbeat).code, grpc::StatusCode::ABORTED);
}

void JobErrorsTest::ProduceOfLimits() {
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(client_.Create(SelftestRequest()).ok());
  EXPECT_EQ(Create([](auto&) {}).reason, "QUOTA_EXCEEDED");
  const JobClient other(server_.channel(), "other");
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(other.Create(SelftestRequest()).ok());
  Remember(other.Create(SelftestRequest()).status());
  BackUp("../x.db");
  std::ofstream(server_.folder() / "file") << "x";
  BackUp("file/x.db");
  v1::BackUpStoreRequest request;
  request.set_path("a.db");
  v1::BackUpStoreResponse response;
  grpc::ClientContext context;
  ASSERT_TRUE(
      v1::AdminService::NewStub(server_.channel())->BackUpStore(&context, request, &response).ok());
  BackUp("a.db");
}

// The words in backquotes in the rows of the table of errors that are about jobs.
std::set<std::string> DocumentedReasons() {
  std::ifstream file(POISE_SOURCE_DIR "/docs/server.md");
  std::set<std::string> reasons;
  for (std::string line; std::getline(file, line);) {
    static const std::regex row(R"(\| [^|]*\| of (a job|a worker|an operator): `([^`]*)`.*)");
    std::smatch match;
    if (!std::regex_match(line, match, row)) continue;
    std::istringstream words(match[2].str());
    reasons.insert(std::istream_iterator<std::string>(words), {});
  }
  return reasons;
}

TEST_F(JobErrorsTest, EveryDocumentedReasonIsProducedAndEveryProducedOneIsDocumented) {
  ProduceOfJobs();
  ProduceOfStates();
  ProduceOfWorkers();
  ProduceOfLimits();
  const std::set<std::string> documented = DocumentedReasons();
  EXPECT_GT(documented.size(), 30u);
  for (const std::string& reason : documented) {
    EXPECT_TRUE(produced_.contains(reason)) << reason << " is in docs/server.md only";
  }
  for (const std::string& reason : produced_) {
    EXPECT_TRUE(documented.contains(reason)) << reason << " is not in docs/server.md";
  }
}

TEST_F(JobErrorsTest, BytesThatAreNoMessageAreRefusedByEveryMethod) {
  for (const char* name : {"poise.v1.JobService", "poise.v1.WorkerService", "poise.v1.AdminService",
                           "google.longrunning.Operations"}) {
    const auto* service =
        google::protobuf::DescriptorPool::generated_pool()->FindServiceByName(name);
    ASSERT_NE(service, nullptr) << name;
    for (int i = 0; i < service->method_count(); ++i) {
      const std::string method = std::string(name) + "/" + service->method(i)->name();
      const Refused refused = CallBytes(method, "\xff\xff\xff");
      EXPECT_EQ(refused.reason, "MALFORMED_REQUEST") << method;
      EXPECT_EQ(refused.code, grpc::StatusCode::INVALID_ARGUMENT) << method;
    }
  }
}

}  // namespace
}  // namespace poise::server
