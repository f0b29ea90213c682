#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <random>
#include <set>
#include <thread>

#include "absl/time/clock.h"
#include "core/base/identifier.h"
#include "tests/support/fake_worker.h"
#include "tests/support/job_client.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using testing::FakeWorker;
using testing::JobClient;
using testing::SelftestRequest;
using testing::TestServer;

// Returns when so many calls wait at the server.
void AwaitCalls(TestServer& server, int calls) {
  while (server.server().calls() < calls) absl::SleepFor(absl::Milliseconds(1));
}

TEST(WorkerServiceTest, JobGoesThroughAWorker) {
  TestServer server;
  const JobClient client(server.channel());
  v1::CreateJobRequest request = SelftestRequest();
  request.set_seed(11);
  (*request.mutable_spec()->mutable_parameters()->mutable_fields())["steps"].set_number_value(7);
  const std::string name = client.Create(request)->name();
  const FakeWorker worker(server.channel());
  const v1::Lease lease = worker.MustLease();
  EXPECT_EQ(lease.fence().job(), name);
  EXPECT_EQ(lease.fence().attempt(), 1);
  EXPECT_EQ(lease.kind(), "selftest");
  EXPECT_EQ(lease.parameters_json(), R"({"steps":7})");
  EXPECT_EQ(lease.seed(), 11u);
  EXPECT_GT(lease.expires_in().seconds(), 0);
  EXPECT_EQ(worker.Heartbeat(lease, 3)->directive(), v1::HeartbeatResponse::CONTINUE);
  EXPECT_EQ(client.Get(name)->progress().step(), 3);
  EXPECT_EQ(client.Get(name)->worker(), "worker-1");
  EXPECT_EQ(worker.Finish(lease)->state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(worker.Finish(lease)->state(), v1::Job::SUCCEEDED);  // the answer was lost
  EXPECT_EQ(client.Get(name)->state(), v1::Job::SUCCEEDED);
}

TEST(WorkerServiceTest, SameTokenGetsTheSameLeaseAndOthersNothing) {
  TestServer server;
  ASSERT_TRUE(JobClient(server.channel()).Create(SelftestRequest()).ok());
  const FakeWorker worker(server.channel());
  v1::LeaseJobRequest request;
  request.set_token("0123456789abcdef");
  const auto first = worker.Lease({}, request), again = worker.Lease({}, request);
  EXPECT_EQ(first->lease().fence().SerializeAsString(), again->lease().fence().SerializeAsString());
  EXPECT_FALSE(worker.Lease()->has_lease());
}

TEST(WorkerServiceTest, WhoLostTheLeaseIsTold) {
  TestServer server;
  ASSERT_TRUE(JobClient(server.channel()).Create(SelftestRequest()).ok());
  const FakeWorker worker(server.channel());
  const v1::Lease lease = worker.MustLease();
  ASSERT_TRUE(worker.Release(lease).ok());
  EXPECT_EQ(base::ErrorReason(worker.Heartbeat(lease).status()), "LEASE_LOST");
  EXPECT_EQ(base::ErrorReason(worker.Finish(lease).status()), "LEASE_LOST");
  const std::string artifact = server.engine().artifacts().Put("state")->name;
  EXPECT_EQ(base::ErrorReason(worker.Checkpoint(lease, artifact, 1)), "LEASE_LOST");
  EXPECT_EQ(worker.MustLease().fence().attempt(), 2);
}

TEST(WorkerServiceTest, LongPollIsAnsweredWhenAJobComes) {
  TestServer server;
  const JobClient client(server.channel());
  const FakeWorker worker(server.channel());
  for (int i = 0; i < 5; ++i) {
    auto lease =
        std::async(std::launch::async, [&] { return worker.MustLease(absl::Seconds(30)); });
    AwaitCalls(server, 1);
    absl::SleepFor(absl::Milliseconds(20));
    const absl::Time created = absl::Now();
    ASSERT_TRUE(client.Create(SelftestRequest()).ok());
    lease.get();
    const absl::Duration delay = absl::Now() - created;
    std::printf("create to lease: %.1f ms\n", absl::ToDoubleMilliseconds(delay));
    // The reaper, which also wakes, comes every 2 s.
    EXPECT_LT(delay, absl::Milliseconds(500));
  }
}

TEST(WorkerServiceTest, LongPollWithoutAJobEndsWithNothing) {
  TestServer server;
  const FakeWorker worker(server.channel());
  const absl::Time begin = absl::Now();
  const auto response = worker.Lease(absl::Milliseconds(200));
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_FALSE(response->has_lease());
  EXPECT_FALSE(response->draining());
  EXPECT_GE(absl::Now() - begin, absl::Milliseconds(200));
}

TEST(WorkerServiceTest, EveryOfManyWaitingWorkersGetsOneOfAsManyJobs) {
  TestServer server;
  constexpr int kWorkers = 40;
  std::vector<std::future<std::string>> leases;
  for (int i = 0; i < kWorkers; ++i) {
    leases.push_back(std::async(std::launch::async, [&server, i] {
      const FakeWorker worker(server.channel(), "worker-" + std::to_string(i));
      return worker.MustLease(absl::Seconds(30)).fence().job();
    }));
  }
  AwaitCalls(server, kWorkers);
  const JobClient client(server.channel());
  for (int i = 0; i < kWorkers; ++i) ASSERT_TRUE(client.Create(SelftestRequest()).ok());
  std::set<std::string> jobs;
  for (auto& lease : leases) jobs.insert(lease.get());
  EXPECT_EQ(jobs.size(), static_cast<size_t>(kWorkers));
}

TEST(WorkerServiceTest, WaitingWorkerOfAnotherKindDoesNotTakeTheWakeUp) {
  TestServer server;
  const FakeWorker other(server.channel(), "other"), worker(server.channel());
  v1::LeaseJobRequest of_other_queue;
  of_other_queue.add_queues("other");
  auto nothing =
      std::async(std::launch::async, [&] { return other.Lease(absl::Seconds(2), of_other_queue); });
  AwaitCalls(server, 1);
  auto lease = std::async(std::launch::async, [&] { return worker.MustLease(absl::Seconds(30)); });
  AwaitCalls(server, 2);
  ASSERT_TRUE(JobClient(server.channel()).Create(SelftestRequest()).ok());
  lease.get();
  EXPECT_FALSE(nothing.get()->has_lease());
}

TEST(WorkerServiceTest, LongPollIsAnsweredWhenTheTimeOfARetryComes) {
  engine::JobManagerConfig jobs;
  jobs.reap_interval = absl::Hours(1);  // it is not the reaper that wakes
  jobs.policy.first_backoff = absl::Milliseconds(300);
  TestServer server({}, 1, jobs);
  ASSERT_TRUE(JobClient(server.channel()).Create(SelftestRequest()).ok());
  const FakeWorker worker(server.channel());
  ASSERT_EQ(worker.Fail(worker.MustLease(), absl::StatusCode::kUnavailable)->state(),
            v1::Job::QUEUED);
  EXPECT_EQ(worker.MustLease(absl::Seconds(20)).fence().attempt(), 2);
}

TEST(WorkerServiceTest, LostWorkersJobGoesToTheOneThatWaits) {
  engine::JobManagerConfig jobs;
  jobs.policy.lease = absl::Milliseconds(300);
  jobs.policy.heartbeat_interval = absl::Milliseconds(100);
  jobs.reap_interval = absl::Milliseconds(100);
  TestServer server({}, 1, jobs);
  ASSERT_TRUE(JobClient(server.channel()).Create(SelftestRequest()).ok());
  const FakeWorker lost(server.channel(), "lost"), worker(server.channel());
  const v1::Lease lease = lost.MustLease();
  EXPECT_EQ(worker.MustLease(absl::Seconds(30)).fence().attempt(), 2);
  EXPECT_EQ(base::ErrorReason(lost.Finish(lease).status()), "LEASE_LOST");
}

TEST(WorkerServiceTest, HeartbeatOnHoldTellsACancelAtOnce) {
  engine::JobManagerConfig jobs;
  jobs.policy.lease = absl::Minutes(10);
  jobs.policy.heartbeat_interval = absl::Minutes(5);
  TestServer server({}, 1, jobs);
  const JobClient client(server.channel());
  const std::string name = client.Create(SelftestRequest())->name();
  const FakeWorker worker(server.channel());
  const v1::Lease lease = worker.MustLease();
  auto answer =
      std::async(std::launch::async, [&] { return worker.Heartbeat(lease, 1, absl::Seconds(25)); });
  AwaitCalls(server, 1);
  // Progress is stored while the answer is held.
  while (client.Get(name)->progress().step() < 1) absl::SleepFor(absl::Milliseconds(1));
  EXPECT_EQ(answer.wait_for(std::chrono::milliseconds(200)), std::future_status::timeout);
  const absl::Time cancelled = absl::Now();
  ASSERT_TRUE(client.Cancel(name).ok());
  EXPECT_EQ(answer.get()->directive(), v1::HeartbeatResponse::CANCEL);
  EXPECT_LT(absl::Now() - cancelled, absl::Seconds(5));
  std::printf("cancel to directive: %.1f ms\n",
              absl::ToDoubleMilliseconds(absl::Now() - cancelled));
}

TEST(WorkerServiceTest, HeartbeatOnHoldTellsALostLeaseAtOnce) {
  TestServer server;
  ASSERT_TRUE(JobClient(server.channel()).Create(SelftestRequest()).ok());
  const FakeWorker worker(server.channel());
  const v1::Lease lease = worker.MustLease();
  auto answer =
      std::async(std::launch::async, [&] { return worker.Heartbeat(lease, 1, absl::Seconds(10)); });
  AwaitCalls(server, 1);
  absl::SleepFor(absl::Milliseconds(50));
  ASSERT_TRUE(server.engine().jobs().ExpireWorker("worker-1").ok());
  EXPECT_EQ(base::ErrorReason(answer.get().status()), "LEASE_LOST");
}

TEST(WorkerServiceTest, HoldEndsBeforeTheLeaseAndTakesItFurther) {
  engine::JobManagerConfig jobs;
  jobs.policy.lease = absl::Milliseconds(900);
  jobs.policy.heartbeat_interval = absl::Milliseconds(300);
  jobs.reap_interval = absl::Milliseconds(50);
  TestServer server({}, 1, jobs);
  ASSERT_TRUE(JobClient(server.channel()).Create(SelftestRequest()).ok());
  const FakeWorker worker(server.channel());
  const v1::Lease lease = worker.MustLease();
  for (int i = 0; i < 6; ++i) {  // two leases long
    const absl::Time begin = absl::Now();
    const auto answer = worker.Heartbeat(lease, i, absl::Seconds(20));
    ASSERT_TRUE(answer.ok()) << answer.status();
    EXPECT_EQ(answer->directive(), v1::HeartbeatResponse::CONTINUE);
    EXPECT_GE(absl::Now() - begin, absl::Milliseconds(290));
  }
  EXPECT_EQ(worker.Finish(lease)->state(), v1::Job::SUCCEEDED);
}

// Asks with one token and short deadlines until there is an answer, as a worker on a bad network. A
// slow machine gets there too: the deadlines grow.
v1::Lease LeaseOverABadNetwork(const FakeWorker& worker, const std::string& name,
                               std::mt19937& random) {
  v1::LeaseJobRequest request;
  request.set_worker(name);
  request.set_token(base::RandomHex(16));
  request.mutable_wait()->set_seconds(10);
  for (int tries = 0;; ++tries) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() +
                         std::chrono::microseconds(500 + random() % 6000) * (1 + tries / 20));
    v1::LeaseJobResponse response;
    const grpc::Status status = worker.stub().LeaseJob(&context, request, &response);
    if (status.ok() && response.has_lease()) return response.lease();
  }
}

TEST(WorkerServiceTest, LongPollsThatBreakOffLoseNoJobAndTakeNoneTwice) {
  TestServer server;
  constexpr int kWorkers = 6, kJobsEach = 25;
  std::vector<std::thread> workers;
  for (unsigned i = 0; i < kWorkers; ++i) {
    workers.emplace_back([&, i] {
      const std::string name = "worker-" + std::to_string(i);
      const FakeWorker worker(server.NewChannel(), name);
      std::mt19937 random(i);
      for (int k = 0; k < kJobsEach; ++k) {
        const v1::Lease lease = LeaseOverABadNetwork(worker, name, random);
        EXPECT_EQ(worker.Finish(lease)->state(), v1::Job::SUCCEEDED);
      }
    });
  }
  const JobClient client(server.channel());
  for (int i = 0; i < kWorkers * kJobsEach; ++i) ASSERT_TRUE(client.Create(SelftestRequest()).ok());
  for (std::thread& worker : workers) worker.join();
  v1::ListJobsRequest list;
  list.set_page_size(1000);
  const v1::ListJobsResponse page = *client.List(list);
  ASSERT_EQ(page.jobs_size(), kWorkers * kJobsEach);
  for (const v1::Job& job : page.jobs()) {
    EXPECT_EQ(job.state(), v1::Job::SUCCEEDED);
    EXPECT_EQ(job.attempt(), 1);  // the answer that was lost came again
  }
}

TEST(WorkerServiceTest, DrainSendsWaitingWorkersAwayAndLeasesNothing) {
  TestServer server;
  const FakeWorker worker(server.channel());
  auto waiting = std::async(std::launch::async, [&] { return worker.Lease(absl::Seconds(30)); });
  AwaitCalls(server, 1);
  server.server().AnnounceShutdown();
  EXPECT_TRUE(waiting.get()->draining());
  // Lame duck: jobs are accepted, none is handed out.
  EXPECT_TRUE(JobClient(server.channel()).Create(SelftestRequest()).ok());
  EXPECT_TRUE(worker.Lease()->draining());
}

TEST(WorkerServiceTest, WhatIsNoWorkersSpeechIsRefused) {
  TestServer server;
  ASSERT_TRUE(JobClient(server.channel()).Create(SelftestRequest()).ok());
  const FakeWorker worker(server.channel());
  v1::LeaseJobRequest request;
  request.set_token("short");
  EXPECT_EQ(base::ErrorReason(worker.Lease({}, request).status()), "BAD_LEASE_TOKEN");
  const v1::Lease lease = worker.MustLease();
  EXPECT_EQ(base::ErrorReason(worker.Checkpoint(lease, "artifacts/x", 1)), "BAD_ARTIFACT_NAME");
  EXPECT_EQ(base::ErrorReason(worker.Checkpoint(lease, "artifacts/" + std::string(64, 'a'), 1)),
            "ARTIFACT_NOT_FOUND");
  v1::FinishJobRequest finish;
  finish.set_outcome(v1::JobAttempt::RUNNING);
  EXPECT_EQ(base::ErrorReason(worker.Finish(lease, finish).status()), "BAD_OUTCOME");
  finish.clear_outcome();
  finish.add_artifacts()->set_name("../../etc/passwd");
  EXPECT_EQ(base::ErrorReason(worker.Finish(lease, finish).status()), "BAD_ARTIFACT_PATH");
  finish.mutable_artifacts(0)->set_name("/etc/passwd");
  EXPECT_EQ(base::ErrorReason(worker.Finish(lease, finish).status()), "BAD_ARTIFACT_PATH");
  v1::Lease nonsense = lease;
  nonsense.mutable_fence()->set_job("x");
  EXPECT_EQ(base::ErrorReason(worker.Heartbeat(nonsense).status()), "BAD_JOB_NAME");
}

}  // namespace
}  // namespace poise::server
