#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <sstream>

#include "absl/time/clock.h"
#include "proto/convert/time_convert.h"
#include "tests/support/fake_worker.h"
#include "tests/support/job_client.h"
#include "tests/support/server_process.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using testing::FakeWorker;
using testing::JobClient;
using testing::SelftestRequest;
using testing::TestServer;

// Values of the metrics page whose name and labels begin with `prefix`, added up.
double Sum(const std::string& page, const std::string& prefix) {
  std::istringstream lines(page);
  double sum = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(prefix)) sum += std::stod(line.substr(line.rfind(' ')));
  }
  return sum;
}

// Jobs that end in every way, or not yet.
void RunSomeJobs(const TestServer& server, bool delete_some) {
  const JobClient client(server.channel()), other(server.channel(), "other");
  const FakeWorker worker(server.channel());
  std::mt19937 random(3);
  for (int i = 0; i < 40; ++i) {
    const JobClient& tenant = i % 3 == 0 ? other : client;
    const std::string name = tenant.Create(SelftestRequest())->name();
    if (random() % 5 == 0) {
      EXPECT_TRUE(tenant.Cancel(name).ok());
    }
    const auto response = worker.Lease();
    if (!response.ok() || !response->has_lease()) continue;
    const v1::Lease& lease = response->lease();
    absl::SleepFor(absl::Milliseconds(random() % 4));
    switch (random() % 5) {
      case 0:
        EXPECT_TRUE(worker.Release(lease).ok());
        break;
      case 1:
        EXPECT_TRUE(worker.Fail(lease, absl::StatusCode::kInvalidArgument).ok());
        break;
      case 2:
        EXPECT_TRUE(worker.Fail(lease, absl::StatusCode::kUnavailable).ok());
        break;
      case 3:
        break;  // keeps it
      default:
        EXPECT_TRUE(worker.Finish(lease).ok());
    }
    if (delete_some && i % 7 == 0) client.Delete(lease.fence().job()).IgnoreError();
  }
}

TEST(JobMetricsTest, NumbersAddUpWithTheStore) {
  TestServer server;
  RunSomeJobs(server, true);
  ASSERT_TRUE(server.engine().jobs().ShowStats().ok());
  const jobs::StoreStats stats = *server.engine().jobs().Stats();
  const std::string page = server.telemetry().Text();
  std::map<api::JobState, int64_t> in_store;
  for (const auto& [tenant, states] : stats.jobs) {
    for (const auto& [state, count] : states) in_store[state] += count;
  }
  double jobs = 0, ended = 0;
  for (const auto& [state, count] : in_store) {
    const std::string label = std::string("{state=\"") + api::JobStateName(state) + "\"}";
    EXPECT_EQ(Sum(page, "poise_jobs" + label), count) << label;
    jobs += count;
    if (api::IsTerminal(state)) ended += count;
  }
  const double submitted = Sum(page, "poise_jobs_submitted_total");
  const double deleted = Sum(page, "poise_jobs_deleted_total");
  EXPECT_EQ(submitted, 40);
  EXPECT_EQ(submitted, stats.submitted);
  EXPECT_EQ(deleted, stats.deleted);
  EXPECT_GT(deleted, 0);
  EXPECT_EQ(submitted - deleted, jobs);
  EXPECT_EQ(Sum(page, "poise_job_leases"), stats.leases);
  EXPECT_EQ(stats.leases, in_store[api::JobState::kRunning] + in_store[api::JobState::kCancelling]);
  double to_terminal = 0;
  for (const char* state : {"SUCCEEDED", "FAILED", "CANCELLED"}) {
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("poise_job_transitions_total") &&
          line.find(std::string("to=\"") + state) != std::string::npos) {
        to_terminal += std::stod(line.substr(line.rfind(' ')));
      }
    }
  }
  EXPECT_EQ(to_terminal, ended + deleted);
}

TEST(JobMetricsTest, TimeInTheQueueAndTimeOfRunsAreTheWholeLife) {
  TestServer server;
  RunSomeJobs(server, false);
  const JobClient client(server.channel()), other(server.channel(), "other");
  // All end, by whatever way.
  for (const JobClient* tenant : {&client, &other}) {
    const v1::ListJobsResponse page = *tenant->List({});
    for (const v1::Job& job : page.jobs()) ASSERT_TRUE(tenant->Cancel(job.name()).ok());
  }
  ASSERT_TRUE(server.engine().jobs().ExpireWorker("worker-1").ok());
  absl::Duration lives;
  for (const JobClient* tenant : {&client, &other}) {
    const v1::ListJobsResponse page = *tenant->List({});
    for (const v1::Job& job : page.jobs()) {
      ASSERT_TRUE(job.has_end_time()) << job.name();
      lives += convert::FromProto(job.end_time()) - convert::FromProto(job.create_time());
    }
  }
  const std::string page = server.telemetry().Text();
  const double measured =
      Sum(page, "poise_job_queue_seconds_sum") + Sum(page, "poise_job_run_seconds_sum");
  EXPECT_NEAR(measured, absl::ToDoubleSeconds(lives), 1e-3);
  EXPECT_GT(measured, 0.01);
}

TEST(JobMetricsTest, EveryChangeOfStateIsOneLogLineWithTheTrace) {
  testing::ServerProcess server;
  const JobClient client(server.NewChannel());
  const v1::Job job = *client.Create(SelftestRequest());
  const FakeWorker worker(server.NewChannel());
  ASSERT_TRUE(worker.Release(worker.MustLease()).ok());
  ASSERT_TRUE(worker.Fail(worker.MustLease(), absl::StatusCode::kInvalidArgument).ok());
  std::vector<std::string> changes;
  std::istringstream lines(server.Log());
  for (std::string line; std::getline(lines, line);) {
    const base::Json entry = *base::ParseJson(line, "log line");
    if (entry["event"] != "job_state") continue;
    EXPECT_EQ("jobs/" + entry["job"].get<std::string>(), job.name());
    EXPECT_EQ(entry["trace_id"], job.trace_id());
    EXPECT_EQ(entry["kind"], "selftest");
    EXPECT_EQ(entry["tenant"], "default");
    EXPECT_TRUE(entry["in_state_ms"].is_number_integer());
    changes.push_back(entry["from"].get<std::string>() + ">" + entry["to"].get<std::string>() +
                      " " + entry["attempt"].dump() + entry["worker"].get<std::string>() +
                      entry["reason"].get<std::string>());
  }
  EXPECT_THAT(changes, ::testing::ElementsAre(
                           ">QUEUED 0", "QUEUED>RUNNING 1worker-1", "RUNNING>QUEUED 1worker-1",
                           "QUEUED>RUNNING 2worker-1", "RUNNING>FAILED 2worker-1AS_ASKED"));
}

}  // namespace
}  // namespace poise::server
