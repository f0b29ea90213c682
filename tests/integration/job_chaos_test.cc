#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "absl/time/clock.h"
#include "tests/integration/nemesis.h"
#include "tests/support/job_calls.h"
#include "tests/support/job_cluster.h"

// Random kills and pauses of everything, then a check of every job's whole history. The order of
// harm comes from a seed: POISE_CHAOS_SEED, POISE_CHAOS_SECONDS for longer runs.
namespace poise::testing {
namespace {

constexpr int kJobs = 260;
constexpr int kKills = 40;
constexpr int kPauses = 20;
constexpr int kDistinct = 8;  // works that differ; the jobs repeat them
const std::vector<std::string> kWorkerFlags = {"--slots", "3"};

// Work number `i` of kDistinct, which takes about 1 to 2.5 s.
api::CreateJob Work(int i, const std::string& request_id) {
  api::CreateJob request = Selftest({{"steps", 25 + 5 * (i % kDistinct)},
                                     {"step_ms", 40},
                                     {"checkpoint_every", 5},
                                     {"artifacts", 1 + i % 2},
                                     {"artifact_bytes", 5000}},
                                    /*seed=*/100 + i % kDistinct, request_id);
  request.limits.max_losses = 100;
  request.limits.max_errors = 100;
  request.limits.stall_timeout = absl::Seconds(20);
  return request;
}

// Every tenth job fails in some way of its own, or is cancelled.
enum class Fate { kSucceeds, kErrorsOnce, kCrashesOnce, kInvalid, kPoison, kCancelled };

Fate FateOf(int i) {
  if (i % 10 != 0) return Fate::kSucceeds;
  constexpr Fate kOthers[] = {Fate::kErrorsOnce, Fate::kCrashesOnce, Fate::kInvalid, Fate::kPoison,
                              Fate::kCancelled};
  return kOthers[i / 10 % 5];
}

api::CreateJob JobNumber(int i) {
  api::CreateJob request = Work(i, fmt::format("job-{}", i));
  base::Json& parameters = request.spec.parameters;
  const auto fails = [&](const char* failure, int attempts) {
    parameters["fail_at"] = 7;
    parameters["failure"] = failure;
    parameters["fail_attempts"] = attempts;
  };
  switch (FateOf(i)) {
    case Fate::kErrorsOnce:
      fails("unavailable", 1);
      break;
    case Fate::kCrashesOnce:
      fails("segfault", 1);
      break;
    case Fate::kInvalid:
      fails("invalid", 1000);
      break;
    case Fate::kPoison:
      fails("segfault", 1000);
      request.limits.max_losses = 2;
      break;
    case Fate::kSucceeds:
    case Fate::kCancelled:
      break;
  }
  return request;
}

std::set<api::JobState> AllowedEnds(Fate fate) {
  switch (fate) {
    case Fate::kInvalid:
    case Fate::kPoison:
      return {api::JobState::kFailed};
    case Fate::kCancelled:  // unless it was quicker
      return {api::JobState::kCancelled, api::JobState::kSucceeded};
    default:
      return {api::JobState::kSucceeded};
  }
}

std::string ArtifactsText(const api::Job& job) {
  std::string text;
  for (const api::JobArtifact& artifact : job.artifacts) {
    text += fmt::format("{} {}\n", artifact.name, artifact.artifact);
  }
  return text;
}

// The artifacts of each distinct work, from runs that nobody disturbs.
std::vector<std::string> UndisturbedResults(const JobCalls& calls) {
  std::vector<std::string> ids, results;
  for (int i = 0; i < kDistinct; ++i) {
    const auto job = calls.Create(Work(i, ""));
    EXPECT_TRUE(job.ok()) << job.status();
    ids.push_back(job.ok() ? job->id : "");
  }
  for (const std::string& id : ids) {
    const api::Job job = WaitForEnd(calls, id);
    EXPECT_EQ(job.state, api::JobState::kSucceeded);
    results.push_back(ArtifactsText(job));
  }
  return results;
}

class JobChaosTest : public ::testing::Test {
 protected:
  JobChaosTest()
      : cluster_({"--lease-seconds", "2", "--heartbeat-seconds", "0.5", "--reap-seconds", "0.3",
                  "--first-backoff-seconds", "0.2", "--max-backoff-seconds", "1"}),
        calls_(cluster_.channel()) {}

  // Submits job `i`, asking again until the server answers, and maybe wishes it cancelled.
  void SubmitJob(int i) {
    const auto job = Persist([&] { return calls_.Create(JobNumber(i)); });
    ASSERT_TRUE(job.ok()) << job.status();
    ids_.push_back(job->id);
    if (FateOf(i) == Fate::kCancelled) to_cancel_.push_back(job->id);
  }

  void CancelOne() {
    if (to_cancel_.empty()) return;
    const auto cancelled = Persist([&] { return calls_.Cancel(to_cancel_.back()); });
    EXPECT_TRUE(cancelled.ok()) << cancelled.status();
    to_cancel_.pop_back();
  }

  void CheckJob(int i, const api::Job& job, const std::string& undisturbed) {
    EXPECT_TRUE(AllowedEnds(FateOf(i)).contains(job.state))
        << "job " << i << " is " << api::JobStateName(job.state) << " "
        << (job.error ? job.error->message : "");
    if (job.state == api::JobState::kSucceeded && FateOf(i) == Fate::kSucceeds) {
      EXPECT_EQ(ArtifactsText(job), undisturbed) << "job " << i;
    }
    const auto events = Persist([&] { return calls_.Events(job.id); });
    ASSERT_TRUE(events.ok()) << events.status();
    EXPECT_EQ(FaultOfHistory(job, *events), "") << "job " << i << " " << job.id;
  }

  JobCluster cluster_;
  JobCalls calls_;
  std::vector<std::string> ids_;
  std::vector<std::string> to_cancel_;
};

TEST_F(JobChaosTest, EveryJobEndsOnceWhoeverIsKilledOrPaused) {
  const int seconds = FromEnvironment("POISE_CHAOS_SECONDS", 0);
  const int seed = FromEnvironment("POISE_CHAOS_SEED", 1);
  for (int i = 0; i < 3; ++i) cluster_.StartWorker(kWorkerFlags);
  const std::vector<std::string> undisturbed = UndisturbedResults(calls_);
  const absl::Time start = absl::Now();
  Nemesis nemesis(cluster_, kWorkerFlags, absl::Seconds(2.5), seed);
  // A supply of jobs until enough harm was done and enough jobs were made.
  const auto enough = [&] {
    return nemesis.harm().kills() >= kKills && nemesis.harm().pauses() >= kPauses &&
           ids_.size() >= kJobs && absl::Now() - start >= absl::Seconds(seconds);
  };
  while (!enough()) {
    const auto waiting = Persist([&] { return calls_.List("state=QUEUED"); });
    ASSERT_TRUE(waiting.ok()) << waiting.status();
    for (size_t i = waiting->size(); i < 15; ++i) SubmitJob(static_cast<int>(ids_.size()));
    CancelOne();
    nemesis.Act();
    absl::SleepFor(absl::Milliseconds(400));
  }
  nemesis.Rest();
  std::map<std::string, int> ends;
  for (size_t i = 0; i < ids_.size(); ++i) {
    const api::Job job = WaitForEnd(calls_, ids_[i], absl::Minutes(3));
    ++ends[api::JobStateName(job.state)];
    CheckJob(static_cast<int>(i), job, undisturbed[i % kDistinct]);
  }
  std::printf("seed %d: %zu jobs in %.0f s through %s:", seed, ids_.size(),
              absl::ToDoubleSeconds(absl::Now() - start), nemesis.harm().ToString().c_str());
  for (const auto& [state, count] : ends) std::printf(" %d %s", count, state.c_str());
  std::printf("\n");

  // The numbers add up: all jobs are terminal, no lease is left, and the page says what the store
  // holds.
  absl::SleepFor(absl::Seconds(2));  // gauges are refreshed now and then
  const auto all = calls_.List();
  ASSERT_TRUE(all.ok());
  EXPECT_EQ(all->size(), ids_.size() + kDistinct);
  EXPECT_EQ(cluster_.Metric("poise_job_leases"), 0);
  EXPECT_EQ(cluster_.Metric("poise_jobs"), static_cast<double>(all->size()));
  for (const auto state : {api::JobState::kSucceeded, api::JobState::kFailed,
                           api::JobState::kCancelled, api::JobState::kQueued}) {
    const auto count = std::count_if(all->begin(), all->end(),
                                     [state](const api::Job& job) { return job.state == state; });
    EXPECT_EQ(cluster_.Metric("poise_jobs", {fmt::format("\"{}\"", api::JobStateName(state))}),
              static_cast<double>(count));
  }
}

}  // namespace
}  // namespace poise::testing
