#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "absl/time/clock.h"
#include "poise/v1/job_service.grpc.pb.h"
#include "proto/convert/job_convert.h"
#include "tests/support/job_calls.h"
#include "tests/support/job_cluster.h"
#include "tests/support/process_inspection.h"
#include "tests/support/sanitizer.h"

// Jobs for as long as asked, with cancels and clients that go away; nothing may grow. Half a minute
// in the usual run, POISE_SOAK_SECONDS=1800 on demand.
namespace poise::testing {
namespace {

// What could grow, at one moment.
struct Sample {
  double server_mib = 0, worker_mib = 0, log_mib = 0;
  double descriptors = 0, threads = 0;
};

Sample Measure(JobCluster& cluster) {
  constexpr double kMib = 1 << 20;
  const ProcessSize server = SizeOf(cluster.server().pid());
  const ProcessSize worker = SizeOf(cluster.worker(0).pid());
  std::error_code error;
  const auto log = std::filesystem::file_size(cluster.data_dir() / "jobs.db-wal", error);
  return {.server_mib = static_cast<double>(server.resident_bytes) / kMib,
          .worker_mib = static_cast<double>(worker.resident_bytes) / kMib,
          .log_mib = error ? 0 : static_cast<double>(log) / kMib,
          .descriptors = static_cast<double>(server.descriptors + worker.descriptors),
          .threads = static_cast<double>(server.threads + worker.threads)};
}

double Median(const std::vector<Sample>& samples, size_t begin, size_t end,
              double Sample::*member) {
  std::vector<double> values;
  for (size_t i = begin; i < end; ++i) values.push_back(samples[i].*member);
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

// A client that begins to watch and goes away without a word.
void WatchAndVanish(const JobCluster& cluster, const std::string& id) {
  const auto stub = v1::JobService::NewStub(cluster.channel());
  grpc::ClientContext context;
  v1::WatchJobRequest request;
  request.set_name(convert::JobName(id));
  const auto reader = stub->WatchJob(&context, request);
  v1::WatchJobResponse first;
  reader->Read(&first);
  context.TryCancel();
  reader->Finish();
}

TEST(JobSoakTest, NothingGrows) {
  const int seconds = FromEnvironment("POISE_SOAK_SECONDS", 30);
  // Old jobs are removed as in a long life, here after a minute and a half.
  JobCluster cluster({"--retention-days", "0.001", "--reap-seconds", "0.5"});
  cluster.StartWorker({"--slots", "4"});
  const JobCalls calls(cluster.channel());
  std::mt19937 random{5};
  std::vector<Sample> samples;
  const absl::Time start = absl::Now();
  int submitted = 0, failed_calls = 0;
  while (absl::Now() - start < absl::Seconds(seconds)) {
    const auto job = calls.Create(Selftest(
        {{"steps", 10}, {"step_ms", 5}, {"checkpoint_every", 4}, {"artifact_bytes", 20'000}},
        random()));
    failed_calls += job.ok() ? 0 : 1;
    if (job.ok()) {
      ++submitted;
      if (random() % 10 == 0) failed_calls += calls.Cancel(job->id).ok() ? 0 : 1;
      if (random() % 5 == 0) WatchAndVanish(cluster, job->id);
    }
    absl::SleepFor(absl::Milliseconds(120));
    samples.push_back(Measure(cluster));
  }
  // The last sixth against the sixth after the first, which warms up.
  const size_t sixth = samples.size() / 6;
  std::printf("%d s, %d jobs; first -> last sixth after warm-up:\n", seconds, submitted);
  const auto check = [&](const char* what, double Sample::*member, double allowed) {
    const double first = Median(samples, sixth, 2 * sixth, member);
    const double last = Median(samples, samples.size() - sixth, samples.size(), member);
    std::printf("  %-28s %8.2f -> %8.2f\n", what, first, last);
    EXPECT_LE(last, first + allowed) << what;
  };
  if (!kInstrumented) {
    check("memory of the server, MiB", &Sample::server_mib, 8);
    check("memory of the worker, MiB", &Sample::worker_mib, 4);
  }
  check("SQLite's log, MiB", &Sample::log_mib, 4);
  check("descriptors", &Sample::descriptors, 4);
  check("threads", &Sample::threads, 4);
  EXPECT_EQ(failed_calls, 0);
  EXPECT_GT(submitted, seconds);
}

}  // namespace
}  // namespace poise::testing
