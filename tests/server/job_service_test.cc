#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <thread>

#include "proto/convert/status_convert.h"
#include "tests/support/fake_worker.h"
#include "tests/support/job_client.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using ::testing::ElementsAre;
using testing::FakeWorker;
using ::testing::HasSubstr;
using testing::JobClient;
using testing::SelftestRequest;
using testing::TestServer;

void ExpectError(const Status& status, absl::StatusCode code, const std::string& reason,
                 const std::string& field = "") {
  EXPECT_EQ(status.code(), code) << status;
  EXPECT_EQ(base::ErrorReason(status), reason) << status;
  EXPECT_EQ(base::ErrorField(status), field) << status;
}

v1::CreateJobRequest WithParameter(const std::string& name, double value) {
  v1::CreateJobRequest request = SelftestRequest();
  (*request.mutable_spec()->mutable_parameters()->mutable_fields())[name].set_number_value(value);
  return request;
}

std::vector<std::string> Names(const v1::ListJobsResponse& page) {
  std::vector<std::string> names;
  for (const v1::Job& job : page.jobs()) names.push_back(job.name());
  return names;
}

TEST(JobServiceTest, CreatedJobIsThereAsItWasAskedFor) {
  TestServer server;
  const JobClient client(server.channel());
  v1::CreateJobRequest request = WithParameter("steps", 7);
  request.set_request_id("r1");
  request.set_queue("night");
  request.set_priority(3);
  request.set_seed(~uint64_t{0});
  (*request.mutable_labels())["run"] = "7";
  request.mutable_limits()->set_max_errors(5);
  const StatusOr<v1::Job> job = client.Create(request);
  ASSERT_TRUE(job.ok()) << job.status();
  EXPECT_EQ(job->state(), v1::Job::QUEUED);
  EXPECT_THAT(job->name(), ::testing::StartsWith("jobs/"));
  EXPECT_EQ(job->trace_id().size(), 32u);
  const StatusOr<v1::Job> got = client.Get(job->name());
  ASSERT_TRUE(got.ok()) << got.status();
  EXPECT_EQ(got->spec().parameters().fields().at("steps").number_value(), 7);
  EXPECT_EQ(got->queue(), "night");
  EXPECT_EQ(got->priority(), 3);
  EXPECT_EQ(got->seed(), ~uint64_t{0});
  EXPECT_EQ(got->labels().at("run"), "7");
  EXPECT_EQ(got->limits().max_errors(), 5);
  EXPECT_EQ(got->SerializeAsString(), job->SerializeAsString());
}

TEST(JobServiceTest, ThirtyTwoClientsThatRaceOneRequestIdMakeOneJob) {
  TestServer server;
  constexpr int kClients = 32;
  std::vector<StatusOr<v1::Job>> jobs(kClients, absl::UnknownError("not called"));
  std::vector<std::thread> clients;
  for (int i = 0; i < kClients; ++i) {
    clients.emplace_back(
        [&, i] { jobs[i] = JobClient(server.NewChannel()).Create(SelftestRequest("the-one")); });
  }
  for (std::thread& client : clients) client.join();
  std::set<std::string> names;
  for (const StatusOr<v1::Job>& job : jobs) {
    ASSERT_TRUE(job.ok()) << job.status();
    names.insert(job->name());
  }
  EXPECT_EQ(names.size(), 1u);
  EXPECT_EQ(JobClient(server.channel()).List({})->jobs_size(), 1);
}

TEST(JobServiceTest, SameRequestIdWithOtherContentIsRefused) {
  TestServer server;
  const JobClient client(server.channel());
  v1::CreateJobRequest request = WithParameter("steps", 7);
  request.set_request_id("r1");
  const std::string name = client.Create(request)->name();
  EXPECT_EQ(client.Create(request)->name(), name);
  v1::CreateJobRequest other = request;
  other.set_seed(1);
  ExpectError(client.Create(other).status(), absl::StatusCode::kInvalidArgument,
              "REQUEST_ID_REUSED", "request_id");
  // Another tenant has request ids of its own.
  EXPECT_NE(JobClient(server.channel(), "other").Create(request)->name(), name);
}

TEST(JobServiceTest, WhatCannotRunIsRefusedWithTheFieldToBlame) {
  TestServer server;
  const JobClient client(server.channel());
  using absl::StatusCode;
  v1::CreateJobRequest request = SelftestRequest();
  request.mutable_spec()->set_kind("juggle");
  ExpectError(client.Create(request).status(), StatusCode::kInvalidArgument, "UNKNOWN_JOB_KIND",
              "spec.kind");
  const Status unknown = client.Create(WithParameter("stepz", 1)).status();
  EXPECT_EQ(unknown.code(), StatusCode::kInvalidArgument) << unknown;
  EXPECT_THAT(base::ErrorField(unknown), HasSubstr("spec.parameters"));
  request = SelftestRequest();
  request.set_priority(11);
  ExpectError(client.Create(request).status(), StatusCode::kInvalidArgument, "BAD_PRIORITY",
              "priority");
  request = SelftestRequest();
  (*request.mutable_labels())["a b"] = "c";
  ExpectError(client.Create(request).status(), StatusCode::kInvalidArgument, "BAD_LABEL", "labels");
  ExpectError(client.Get("clips/1").status(), StatusCode::kInvalidArgument, "BAD_JOB_NAME", "name");
  ExpectError(client.Get("jobs/nobody").status(), StatusCode::kNotFound, "JOB_NOT_FOUND", "name");
}

TEST(JobServiceTest, TenantsDoNotSeeEachOther) {
  TestServer server;
  const JobClient ours(server.channel(), "ours"), theirs(server.channel(), "theirs");
  const std::string name = ours.Create(SelftestRequest())->name();
  using absl::StatusCode;
  ExpectError(theirs.Get(name).status(), StatusCode::kNotFound, "JOB_NOT_FOUND", "name");
  ExpectError(theirs.Cancel(name).status(), StatusCode::kNotFound, "JOB_NOT_FOUND", "name");
  ExpectError(theirs.Delete(name), StatusCode::kNotFound, "JOB_NOT_FOUND", "name");
  ExpectError(theirs.Retry(name).status(), StatusCode::kNotFound, "JOB_NOT_FOUND", "name");
  ExpectError(theirs.Watch(name, 0, {}), StatusCode::kNotFound, "JOB_NOT_FOUND", "name");
  ExpectError(theirs.Result(name).status(), StatusCode::kNotFound, "JOB_NOT_FOUND", "name");
  EXPECT_EQ(theirs.List({})->jobs_size(), 0);
  EXPECT_EQ(ours.List({})->jobs_size(), 1);
  EXPECT_EQ(base::ErrorReason(JobClient(server.channel(), "a/b").List({}).status()), "BAD_TENANT");
}

TEST(JobServiceTest, ListsArePagedNewestFirstAndFiltered) {
  TestServer server;
  const JobClient client(server.channel());
  std::vector<std::string> newest_first;
  for (int i = 0; i < 7; ++i) {
    v1::CreateJobRequest request = SelftestRequest();
    (*request.mutable_labels())["parity"] = i % 2 == 0 ? "even" : "odd";
    newest_first.insert(newest_first.begin(), client.Create(request)->name());
  }
  v1::ListJobsRequest request;
  request.set_page_size(3);
  std::vector<std::string> seen;
  for (;;) {
    const StatusOr<v1::ListJobsResponse> page = client.List(request);
    ASSERT_TRUE(page.ok()) << page.status();
    for (const std::string& name : Names(*page)) seen.push_back(name);
    if (page->next_page_token().empty()) break;
    request.set_page_token(page->next_page_token());
  }
  EXPECT_EQ(seen, newest_first);
  v1::ListJobsRequest odd;
  odd.set_filter("label.parity=odd state=QUEUED kind=selftest");
  EXPECT_THAT(Names(*client.List(odd)),
              ElementsAre(newest_first[1], newest_first[3], newest_first[5]));
  odd.set_page_token(request.page_token());
  EXPECT_EQ(base::ErrorReason(client.List(odd).status()), "BAD_PAGE_TOKEN");
  odd.clear_page_token();
  odd.set_filter("colour=red");
  EXPECT_EQ(base::ErrorReason(client.List(odd).status()), "BAD_FILTER");
  odd.clear_filter();
  odd.set_page_size(-1);
  EXPECT_EQ(base::ErrorReason(client.List(odd).status()), "BAD_PAGE_SIZE");
}

TEST(JobServiceTest, PageOfLargeJobsIsShorterThanAskedForAndNoneIsMissing) {
  TestServer server;
  const JobClient client(server.channel());
  v1::CreateJobRequest request = SelftestRequest();
  for (int i = 0; i < 64; ++i) {
    (*request.mutable_labels())["label" + std::to_string(i)] = std::string(256, 'x');
  }
  constexpr int kJobs = 1000;  // of 17 kB each
  std::vector<std::thread> clients;
  for (int i = 0; i < 8; ++i) {
    clients.emplace_back([&] {
      for (int k = 0; k < kJobs / 8; ++k) EXPECT_TRUE(client.Create(request).ok());
    });
  }
  for (std::thread& each : clients) each.join();
  v1::ListJobsRequest list;
  list.set_page_size(kJobs);
  std::set<std::string> seen;
  int pages = 0;
  do {
    const StatusOr<v1::ListJobsResponse> page = client.List(list);
    ASSERT_TRUE(page.ok()) << page.status();
    EXPECT_LT(page->ByteSizeLong(), 17u << 20);
    for (const std::string& name : Names(*page)) EXPECT_TRUE(seen.insert(name).second);
    list.set_page_token(page->next_page_token());
    ++pages;
  } while (!list.page_token().empty());
  EXPECT_EQ(seen.size(), static_cast<size_t>(kJobs));
  EXPECT_GT(pages, 1);
}

TEST(JobServiceTest, QueuedJobIsCancelledAtOnce) {
  TestServer server;
  const JobClient client(server.channel());
  const std::string name = client.Create(SelftestRequest())->name();
  const StatusOr<v1::Job> cancelled = client.Cancel(name);
  ASSERT_TRUE(cancelled.ok()) << cancelled.status();
  EXPECT_EQ(cancelled->state(), v1::Job::CANCELLED);
  EXPECT_EQ(cancelled->error().code(), static_cast<int>(absl::StatusCode::kCancelled));
  EXPECT_THAT(cancelled->cancel_requested_by(), HasSubstr("127.0.0.1"));
  EXPECT_FALSE(FakeWorker(server.channel()).Lease()->has_lease());
  // As it is, however often.
  EXPECT_EQ(client.Cancel(name)->event_seq(), cancelled->event_seq());
}

TEST(JobServiceTest, RunningJobIsCancellingUntilItsWorkerHasStopped) {
  TestServer server;
  const JobClient client(server.channel());
  const std::string name = client.Create(SelftestRequest())->name();
  const FakeWorker worker(server.channel());
  const v1::Lease lease = worker.MustLease();
  EXPECT_EQ(client.Get(name)->state(), v1::Job::RUNNING);
  EXPECT_EQ(client.Cancel(name)->state(), v1::Job::CANCELLING);
  EXPECT_EQ(worker.Heartbeat(lease)->directive(), v1::HeartbeatResponse::CANCEL);
  EXPECT_EQ(worker.Fail(lease, absl::StatusCode::kCancelled)->state(), v1::Job::CANCELLED);
  const StatusOr<v1::Job> job = client.Get(name);
  EXPECT_EQ(job->state(), v1::Job::CANCELLED);
  ASSERT_EQ(job->attempts_size(), 1);
  EXPECT_EQ(job->attempts(0).outcome(), v1::JobAttempt::CANCELLED);
}

TEST(JobServiceTest, OnlyAJobThatEndedIsDeleted) {
  TestServer server;
  const JobClient client(server.channel());
  const std::string name = client.Create(SelftestRequest())->name();
  ExpectError(client.Delete(name), absl::StatusCode::kFailedPrecondition, "JOB_NOT_TERMINAL",
              "name");
  ASSERT_TRUE(client.Cancel(name).ok());
  EXPECT_TRUE(client.Delete(name).ok());
  ExpectError(client.Get(name).status(), absl::StatusCode::kNotFound, "JOB_NOT_FOUND", "name");
}

TEST(JobServiceTest, RetryMakesANewJobThatGoesOnFromTheLastCheckpoint) {
  TestServer server;
  const JobClient client(server.channel());
  const std::string name = client.Create(WithParameter("steps", 9))->name();
  ExpectError(client.Retry(name).status(), absl::StatusCode::kFailedPrecondition,
              "JOB_NOT_RETRYABLE", "name");
  const FakeWorker worker(server.channel());
  const v1::Lease lease = worker.MustLease();
  const std::string artifact = server.engine().artifacts().Put("state after step 4")->name;
  ASSERT_TRUE(worker.Checkpoint(lease, artifact, 4).ok());
  EXPECT_EQ(worker.Fail(lease, absl::StatusCode::kInvalidArgument)->state(), v1::Job::FAILED);
  const StatusOr<v1::Job> retried = client.Retry(name, "again");
  ASSERT_TRUE(retried.ok()) << retried.status();
  EXPECT_NE(retried->name(), name);
  EXPECT_EQ(retried->retry_of(), name);
  EXPECT_EQ(retried->state(), v1::Job::QUEUED);
  EXPECT_EQ(retried->spec().parameters().fields().at("steps").number_value(), 9);
  EXPECT_EQ(client.Retry(name, "again")->name(), retried->name());
  const v1::Lease second = worker.MustLease();
  EXPECT_EQ(second.fence().job(), retried->name());
  EXPECT_EQ(second.checkpoint().step(), 4);
  EXPECT_EQ(second.checkpoint().artifact(), artifact);
}

TEST(JobServiceTest, ResultComesAsAStreamOfFilesInChunks) {
  TestServer server;
  const JobClient client(server.channel());
  const std::string name = client.Create(SelftestRequest())->name();
  ExpectError(client.Result(name).status(), absl::StatusCode::kFailedPrecondition,
              "JOB_NOT_SUCCEEDED", "name");
  const FakeWorker worker(server.channel());
  std::string large((2 << 20) + 5, 'a');
  large.back() = 'z';
  v1::FinishJobRequest finish;
  for (const auto& [path, bytes] : std::vector<std::pair<std::string, std::string>>{
           {"variants/1.bvh", large}, {"empty.txt", ""}, {"manifest.json", "{}"}}) {
    v1::JobArtifact* artifact = finish.add_artifacts();
    artifact->set_name(path);
    artifact->set_artifact(server.engine().artifacts().Put(bytes)->name);
    artifact->set_size_bytes(static_cast<int64_t>(bytes.size()));
    artifact->set_media_type("text/plain");
  }
  EXPECT_EQ(worker.Finish(worker.MustLease(), finish)->state(), v1::Job::SUCCEEDED);
  const auto chunks = client.Result(name);
  ASSERT_TRUE(chunks.ok()) << chunks.status();
  std::map<std::string, std::string> files;
  std::string current;
  for (const v1::JobResultChunk& chunk : *chunks) {
    EXPECT_LE(chunk.chunk().size(), 1u << 20);
    if (chunk.has_artifact()) current = chunk.artifact().name();
    files[current] += chunk.chunk();
  }
  EXPECT_EQ(files.size(), 3u);
  EXPECT_TRUE(files["variants/1.bvh"] == large);
  EXPECT_EQ(files["empty.txt"], "");
  EXPECT_EQ(files["manifest.json"], "{}");
  EXPECT_EQ(client.Result(name, "manifest.json")->at(0).chunk(), "{}");
  ExpectError(client.Result(name, "no.txt").status(), absl::StatusCode::kNotFound,
              "ARTIFACT_NOT_FOUND", "artifact");
}

TEST(JobServiceTest, QuotaOfATenantIsTheTenantsOwn) {
  engine::JobManagerConfig jobs;
  jobs.policy.max_queued_per_tenant = 2;
  TestServer server({}, 1, jobs);
  const JobClient ours(server.channel(), "ours"), theirs(server.channel(), "theirs");
  ASSERT_TRUE(ours.Create(SelftestRequest()).ok());
  ASSERT_TRUE(ours.Create(SelftestRequest("r2")).ok());
  const Status refused = ours.Create(SelftestRequest()).status();
  ExpectError(refused, absl::StatusCode::kResourceExhausted, "QUOTA_EXCEEDED");
  EXPECT_TRUE(base::RetryDelay(refused).has_value());
  EXPECT_TRUE(ours.Create(SelftestRequest("r2")).ok());  // known already
  EXPECT_TRUE(theirs.Create(SelftestRequest()).ok());
}

TEST(JobServiceTest, JobCarriesTheTraceOfItsCaller) {
  TestServer server;
  const JobClient client(server.channel());
  const auto context = client.NewContext();
  const std::string trace = "4bf92f3577b34da6a3ce929d0e0e4736";
  context->AddMetadata("traceparent", "00-" + trace + "-00f067aa0ba902b7-01");
  v1::Job job;
  ASSERT_TRUE(client.stub().CreateJob(context.get(), SelftestRequest(), &job).ok());
  EXPECT_EQ(job.trace_id(), trace);
  EXPECT_EQ(FakeWorker(server.channel()).MustLease().trace_id(), trace);
}

}  // namespace
}  // namespace poise::server
