#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <random>

#include "absl/time/clock.h"
#include "client/client.h"
#include "core/motion/dataset/clip_set_file.h"
#include "tests/support/job_calls.h"
#include "tests/support/job_cluster.h"
#include "tests/support/process_inspection.h"
#include "tests/support/sanitizer.h"
#include "tests/support/test_clips.h"

// A job whose processes are killed goes on from its last checkpoint and ends with the same bytes.
namespace poise::testing {
namespace {

constexpr double kLease = 2;
constexpr double kReap = 0.5;
constexpr int kStepMs = 20;

JobCluster NewCluster() {
  return JobCluster(
      {"--lease-seconds", "2", "--heartbeat-seconds", "0.5", "--reap-seconds", "0.5"});
}

api::CreateJob LongJob(int seconds, int checkpoint_every, const std::string& queue) {
  api::CreateJob request = Selftest({{"steps", seconds * 1000 / kStepMs},
                                     {"step_ms", kStepMs},
                                     {"checkpoint_every", checkpoint_every},
                                     {"artifacts", 3},
                                     {"artifact_bytes", 100'000}},
                                    /*seed=*/7);
  request.queue = queue;
  return request;
}

// When an attempt was killed, and which.
struct Kill {
  absl::Time time;
  int attempt = 0;
};

// Kills the job's child or its supervisor; the supervisor is replaced.
Kill KillSomething(JobCluster& cluster, size_t& worker, bool supervisor, const api::Job& job) {
  const auto children = LivingChildrenOf(cluster.worker(worker).pid());
  const Kill kill{absl::Now(), job.attempt};
  if (supervisor) {
    cluster.worker(worker).Signal(SIGKILL);
    cluster.worker(worker).Wait();
    worker = cluster.StartWorker({"--queues", "rough", "--slots", "1"});
  } else {
    for (const pid_t child : children) ::kill(child, SIGKILL);
  }
  return kill;
}

// Kills a job of about `seconds` of work at random moments, each after some progress since the
// last.
std::vector<Kill> KillAgainAndAgain(JobCluster& cluster, size_t& worker, const JobCalls& calls,
                                    const std::string& id, int kills, double seconds) {
  std::mt19937 random{3};
  std::vector<Kill> done;
  for (int i = 0; i < kills; ++i) {
    // While it runs, and after some progress in this attempt.
    const double pause =
        std::uniform_real_distribution<double>(0.3, 1.4)(random) * seconds / (kills + 1.0);
    WaitForJob(calls, id, [&](const api::Job& job) {
      if (api::IsTerminal(job.state)) return true;
      return job.attempt > static_cast<int>(done.size()) && !job.attempts.empty() &&
             job.attempts.back().last_step > job.attempts.back().from_step;
    });
    absl::SleepFor(absl::Seconds(pause));
    const auto job = calls.Get(id);
    if (!job.ok() || job->state != api::JobState::kRunning) break;
    done.push_back(KillSomething(cluster, worker, i % 2 == 0, *job));
  }
  return done;
}

// What a kill cost, from the job's own account.
struct Cost {
  double lost_work_s = 0;  // steps done and not checkpointed
  double delay_s = 0;      // from the kill to the next attempt
};

Cost CostOf(const api::Job& job, const Kill& kill) {
  const api::JobAttempt& killed = job.attempts[kill.attempt - 1];
  const api::JobAttempt& next = job.attempts[kill.attempt];
  return {.lost_work_s = static_cast<double>(killed.last_step - next.from_step) * kStepMs * 1e-3,
          .delay_s = absl::ToDoubleSeconds(next.start - kill.time)};
}

TEST(JobResumeTest, AJobKilledAtRandomMomentsEndsWithTheBytesOfAnUndisturbedOne) {
  const int seconds = FromEnvironment("POISE_RESUME_SECONDS", 20);
  const int kills = FromEnvironment("POISE_RESUME_KILLS", 5);
  // A twentieth of the job, at most the 20 s that no kind of ours exceeds.
  const double interval_s = std::min(20.0, seconds / 20.0);
  const int checkpoint_every = static_cast<int>(interval_s * 1000) / kStepMs;
  JobCluster cluster = NewCluster();
  cluster.StartWorker({"--queues", "calm", "--slots", "1"});
  size_t rough = cluster.StartWorker({"--queues", "rough", "--slots", "1"});
  const JobCalls calls(cluster.channel());
  const auto calm_job = calls.Create(LongJob(seconds, checkpoint_every, "calm"));
  const auto rough_job = calls.Create(LongJob(seconds, checkpoint_every, "rough"));
  ASSERT_TRUE(calm_job.ok() && rough_job.ok()) << calm_job.status() << rough_job.status();

  const std::vector<Kill> done =
      KillAgainAndAgain(cluster, rough, calls, rough_job->id, kills, seconds);
  EXPECT_GE(done.size(), static_cast<size_t>(kills) - 1);

  const auto timeout = absl::Seconds(seconds * 3 + 60);
  const api::Job undisturbed = WaitForEnd(calls, calm_job->id, timeout);
  const api::Job resumed = WaitForEnd(calls, rough_job->id, timeout);
  ASSERT_EQ(undisturbed.state, api::JobState::kSucceeded);
  ASSERT_EQ(resumed.state, api::JobState::kSucceeded) << resumed.error->message;
  EXPECT_EQ(undisturbed.attempt, 1);
  EXPECT_EQ(resumed.attempt, static_cast<int>(done.size()) + 1);
  ASSERT_EQ(undisturbed.artifacts.size(), 4u) << "three files and the manifest";
  EXPECT_EQ(resumed.artifacts, undisturbed.artifacts) << "byte for byte: names are digests";
  double most_lost = 0, longest_delay = 0;
  for (const Kill& kill : done) {
    const Cost cost = CostOf(resumed, kill);
    most_lost = std::max(most_lost, cost.lost_work_s);
    longest_delay = std::max(longest_delay, cost.delay_s);
  }
  std::printf(
      "%d s of work, killed %zu times: %d attempts, at most %.2f s of work lost per kill "
      "(checkpoints every %.2f s), next attempt at most %.2f s after a kill (lease %.1f s + reaper "
      "%.1f s)\n",
      seconds, done.size(), resumed.attempt, most_lost, interval_s, longest_delay, kLease, kReap);
  EXPECT_LE(most_lost, interval_s + 0.5);  // and what passes before a checkpoint is committed
  const double start_of_worker = 1;
  EXPECT_LE(longest_delay, kLease + kReap + start_of_worker);
  const auto events = calls.Events(rough_job->id);
  ASSERT_TRUE(events.ok());
  EXPECT_EQ(FaultOfHistory(resumed, *events), "");
}

// Completes the parameters of a job with what it works on, which it puts onto the server.
using Uploader = std::function<Status(client::Client& client, base::Json& parameters)>;

// A kick of this project.
Status UploadKick(client::Client& client, base::Json& parameters) {
  POISE_ASSIGN_OR_RETURN(const auto stored,
                         client.UploadFile(std::string(POISE_SAMPLES_DIR) + "/kick.bvh"));
  parameters["sources"] = {{{"artifact", stored.name}, {"name", "kick.bvh"}}};
  return absl::OkStatus();
}

Status UploadSwings(client::Client& client, base::Json& parameters) {
  motion::ClipSet set;
  for (int i = 0; i < 4; ++i) {
    set.clips.push_back({"swing", "a", SwingingClip(120 + 24 * i, 120, 0.3, i)});
  }
  POISE_ASSIGN_OR_RETURN(const auto stored, client.Upload(motion::EncodeClipSet(set)));
  parameters["data_artifact"] = stored.name;
  return absl::OkStatus();
}

StatusOr<api::CreateJob> Request(const std::string& server, const std::string& kind,
                                 base::Json parameters, const Uploader& upload) {
  client::ClientOptions options;
  options.server = server;
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options));
  POISE_RETURN_IF_ERROR(upload(*client, parameters));
  api::CreateJob request;
  request.spec = {.kind = kind, .parameters = std::move(parameters)};
  request.seed = 11;
  return request;
}

// Does a job with and without kills, and compares.
void ExpectThatKillsChangeNothing(const std::string& kind, const base::Json& parameters,
                                  const Uploader& upload, size_t files) {
  const int kills = FromEnvironment("POISE_RESUME_KILLS", 5);
  JobCluster cluster = NewCluster();
  cluster.StartWorker({"--queues", "calm", "--slots", "1"});
  const JobCalls calls(cluster.channel());
  auto request = Request(cluster.address(), kind, parameters, upload);
  ASSERT_TRUE(request.ok()) << request.status();
  request->queue = "calm";
  const auto calm_job = calls.Create(*request);
  ASSERT_TRUE(calm_job.ok()) << calm_job.status();
  const auto timeout = absl::Seconds(300);
  const api::Job undisturbed = WaitForEnd(calls, calm_job->id, timeout);
  ASSERT_EQ(undisturbed.state, api::JobState::kSucceeded) << undisturbed.error->message;
  const double seconds = absl::ToDoubleSeconds(undisturbed.end_time - undisturbed.start_time);

  size_t rough = cluster.StartWorker({"--queues", "rough", "--slots", "1"});
  request->queue = "rough";
  const auto rough_job = calls.Create(*request);
  ASSERT_TRUE(rough_job.ok()) << rough_job.status();
  const std::vector<Kill> done =
      KillAgainAndAgain(cluster, rough, calls, rough_job->id, kills, seconds);
  EXPECT_GE(done.size(), static_cast<size_t>(kills) - 1);
  const api::Job resumed = WaitForEnd(calls, rough_job->id, timeout);
  ASSERT_EQ(resumed.state, api::JobState::kSucceeded) << resumed.error->message;
  EXPECT_EQ(resumed.attempt, static_cast<int>(done.size()) + 1);
  ASSERT_EQ(undisturbed.artifacts.size(), files + 1) << "the files and the manifest";
  EXPECT_EQ(resumed.artifacts, undisturbed.artifacts) << "byte for byte: names are digests";
  EXPECT_GT(resumed.attempts.back().from_step, 0) << "it went on, and did not begin again";
  std::string steps;
  for (const api::JobAttempt& attempt : resumed.attempts) {
    steps += fmt::format(" {}-{}", attempt.from_step, attempt.last_step);
  }
  std::printf("%s of %.1f s, killed %zu times: %d attempts, steps%s of %ld\n", kind.c_str(),
              seconds, done.size(), resumed.attempt, steps.c_str(),
              static_cast<long>(resumed.progress.total));
}

TEST(JobResumeTest, ACorrectionKilledAtRandomMomentsEndsWithTheBytesOfAnUndisturbedOne) {
  POISE_SKIP_WHERE_INSTRUMENTED();
  ExpectThatKillsChangeNothing("correct", {{"variants_per_source", 20}}, UploadKick, 20);
}

// A small network that learns for some seconds, so that most kills come while it does.
TEST(JobResumeTest, ALearnedCorrectionKilledAtRandomMomentsEndsWithTheBytesOfAnUndisturbedOne) {
  POISE_SKIP_WHERE_INSTRUMENTED();
  ExpectThatKillsChangeNothing("correct",
                               {{"effort", "full"},
                                {"variants_per_source", 2},
                                {"overrides",
                                 {{"imitation.max_samples", "24000"},
                                  {"imitation.evaluate_every", "1"},
                                  {"imitation.held_out", "1"},
                                  {"imitation.ppo.samples_per_update", "512"},
                                  {"imitation.ppo.actor.hidden_layers", "32-32"},
                                  {"imitation.ppo.critic.hidden_layers", "32-32"},
                                  {"imitation.ppo.threads", "1"},
                                  {"learning.rollouts", "2"}}}},
                               UploadKick, 2);
}

TEST(JobResumeTest, ATrainingKilledAtRandomMomentsEndsWithTheWeightsOfAnUndisturbedOne) {
  POISE_SKIP_WHERE_INSTRUMENTED();
  ExpectThatKillsChangeNothing(
      "train_vae",
      {{"action_class", "swing"},
       {"set", {{"trainer.steps", "600"}, {"trainer.batch_size", "8"}, {"net.hidden", "64"}}}},
      UploadSwings, 4);
}

TEST(JobResumeTest, AJobOutlivesItsServerWithinTheLease) {
  JobCluster cluster({"--lease-seconds", "10", "--heartbeat-seconds", "1"});
  cluster.StartWorker({"--slots", "1"});
  const JobCalls calls(cluster.channel());
  const auto job = calls.Create(Selftest({{"steps", 200}, {"step_ms", 20}}));
  ASSERT_TRUE(job.ok()) << job.status();
  WaitForJob(calls, job->id, [](const api::Job& now) { return now.progress.step > 10; });
  ASSERT_EQ(cluster.StopServer(SIGKILL), -SIGKILL);
  absl::SleepFor(absl::Seconds(1));
  ASSERT_TRUE(cluster.StartServer());
  const api::Job ended = WaitForEnd(calls, job->id);
  EXPECT_EQ(ended.state, api::JobState::kSucceeded);
  EXPECT_EQ(ended.attempt, 1) << "the attempt went on through the outage";
}

}  // namespace
}  // namespace poise::testing
