#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdio>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <thread>
#include <vector>

#include "absl/time/clock.h"
#include "core/base/identifier.h"
#include "tests/support/job_calls.h"
#include "tests/support/job_cluster.h"

// A job that was accepted is there, whatever happens to the server.
namespace poise::testing {
namespace {

constexpr int kClients = 4;

api::CreateJob RequestOfRound(int round, const std::string& request_id) {
  api::CreateJob request = Selftest({{"steps", 1}}, 1, request_id);
  request.labels = {{"round", std::to_string(round)}};
  return request;
}

// What clients sent and what the server said to it.
struct Record {
  std::mutex mutex;
  std::map<std::string, std::string> accepted;  // request id -> job id
  std::vector<std::string> unknown;             // no answer came
};

// Submits until the server is gone.
void SubmitUntilGone(const JobCalls& calls, int round, Record& record) {
  for (;;) {
    const std::string request_id = base::RandomHex(8);
    const auto job = calls.Create(RequestOfRound(round, request_id));
    std::lock_guard lock(record.mutex);
    if (!job.ok()) {
      record.unknown.push_back(request_id);
      return;
    }
    record.accepted[request_id] = job->id;
  }
}

// Submits from several clients and kills the server after a moment.
void KillWhileSubmitting(JobCluster& cluster, int round, absl::Duration moment, Record& record) {
  const JobCalls calls(cluster.channel(), absl::Seconds(5));
  std::vector<std::thread> clients;
  for (int i = 0; i < kClients; ++i) {
    clients.emplace_back([&] { SubmitUntilGone(calls, round, record); });
  }
  absl::SleepFor(moment);
  cluster.StopServer(SIGKILL);
  for (std::thread& client : clients) client.join();
}

TEST(JobDurabilityTest, EveryAcceptedJobIsFoundOnceAfterTheServerIsKilledAtAnyMoment) {
  const int rounds = FromEnvironment("POISE_KILL_ROUNDS", 25);
  JobCluster cluster({"--max-queued-per-tenant", "1000000"});
  std::mt19937 random{1};
  size_t accepted = 0, unanswered = 0, kept_unanswered = 0;
  for (int round = 0; round < rounds; ++round) {
    Record record;
    const double moment = std::uniform_real_distribution<double>(0.0, 0.25)(random);
    KillWhileSubmitting(cluster, round, absl::Seconds(moment), record);
    ASSERT_TRUE(cluster.StartServer());
    const JobCalls calls(cluster.channel());
    const std::string filter = fmt::format("label.round={}", round);
    const auto found = Persist([&] { return calls.List(filter); });
    ASSERT_TRUE(found.ok()) << found.status();
    std::map<std::string, std::string> kept;
    for (const api::Job& job : *found) {
      ASSERT_TRUE(kept.emplace(job.request_id, job.id).second) << job.request_id << " twice";
    }
    for (const auto& [request_id, id] : record.accepted) ASSERT_EQ(kept[request_id], id);
    for (const std::string& request_id : record.unknown) {
      kept_unanswered += kept.contains(request_id) ? 1 : 0;
      // Who got no answer asks again, and has one job in the end.
      const auto again = Persist([&] { return calls.Create(RequestOfRound(round, request_id)); });
      ASSERT_TRUE(again.ok()) << again.status();
      if (kept.contains(request_id)) {
        ASSERT_EQ(again->id, kept[request_id]);
      }
    }
    const auto in_the_end = Persist([&] { return calls.List(filter); });
    ASSERT_TRUE(in_the_end.ok());
    ASSERT_EQ(in_the_end->size(), record.accepted.size() + record.unknown.size());
    accepted += record.accepted.size();
    unanswered += record.unknown.size();
  }
  std::printf(
      "%d rounds: %zu jobs accepted, all found once; %zu calls without an answer, of which %zu had "
      "been kept\n",
      rounds, accepted, unanswered, kept_unanswered);
  EXPECT_GT(accepted, static_cast<size_t>(rounds));
}

TEST(JobDurabilityTest, AServerKilledBetweenCommitAndAnswerHasTheJobForTheRetry) {
  JobCluster cluster;
  ASSERT_EQ(cluster.StopServer(SIGKILL), -SIGKILL);
  ASSERT_TRUE(cluster.StartServer({{"POISE_FAIL_POINTS", "jobs.after_submit=kill"}}));
  const JobCalls calls(cluster.channel());
  const auto lost = calls.Create(RequestOfRound(0, "once"));
  EXPECT_EQ(lost.status().code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(cluster.server().Wait(), -SIGKILL);
  ASSERT_TRUE(cluster.StartServer());
  const auto kept = Persist([&] { return calls.List(); });
  ASSERT_TRUE(kept.ok());
  ASSERT_EQ(kept->size(), 1u) << "the job was committed";
  const auto again = calls.Create(RequestOfRound(0, "once"));
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_EQ(again->id, (*kept)[0].id);
  EXPECT_EQ(calls.List()->size(), 1u);
}

}  // namespace
}  // namespace poise::testing
