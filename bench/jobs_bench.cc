#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "bench/benchmark.h"
#include "core/runtime/jobs/sqlite_job_store.h"

/// What the job store keeps up with, on a disk, with a sync behind every answer: submits, whole
/// cycles of a worker (claim, heartbeat, finish), and whether a claim costs more when 100 times as
/// many jobs wait.
namespace poise::bench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kCallers = 64;
constexpr int kSubmits = 20'000;
constexpr int kSubmitsOfOne = 2'000;
constexpr int kCycles = 10'000;
constexpr double kRateLimit = 1000;  // per second
constexpr int kFewJobs = 1'000;
constexpr int kManyJobs = 100'000;
constexpr int kClaimsOfCaller = 5;
constexpr int kClaimRounds = 41;
constexpr double kClaimRatioLimit = 1.5;
constexpr int kTenants = 10;

double Seconds(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

// A folder on a disk: /tmp may be memory, /var/tmp outlives a restart.
class DiskFolder {
 public:
  DiskFolder() {
    if (mkdtemp(path_.data()) == nullptr) std::abort();
  }
  ~DiskFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  fs::path path() const { return path_; }

 private:
  std::string path_ = "/var/tmp/poise_jobs_bench_XXXXXX";
};

// How many times a second this disk takes a small write that must last, one after the other.
double SyncsPerSecond(const fs::path& folder) {
  constexpr int kSyncs = 500;
  const int file = open((folder / "syncs").c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0644);
  const std::array<char, 4096> bytes{};
  const auto start = Clock::now();
  for (int i = 0; i < kSyncs; ++i) {
    if (write(file, bytes.data(), bytes.size()) < 0 || fdatasync(file) != 0) std::abort();
  }
  const double seconds = Seconds(start);
  close(file);
  return kSyncs / seconds;
}

// Calls `work(caller, i)` for i = 0 .. count - 1 from `callers` threads; returns calls per second.
double RateOf(int callers, int count, const std::function<void(int, int)>& work) {
  std::atomic<int> next = 0;
  std::vector<std::thread> threads;
  const auto start = Clock::now();
  for (int caller = 0; caller < callers; ++caller) {
    threads.emplace_back([&, caller] {
      for (int i = next++; i < count; i = next++) work(caller, i);
    });
  }
  for (std::thread& thread : threads) thread.join();
  return count / Seconds(start);
}

std::string Worker(int caller) { return fmt::format("worker-{}", caller); }

// Jobs on a disk, and the callers as workers.
struct Store {
  explicit Store(const fs::path& folder) {
    auto opened = jobs::OpenSqliteJobStore(
        {.path = folder / "jobs.db", .policy = {.max_queued_per_tenant = kManyJobs}});
    if (!opened.ok()) std::abort();
    jobs = std::move(*opened);
    for (int caller = 0; caller < kCallers; ++caller) {
      if (!jobs->UpsertWorker({.id = Worker(caller)}).ok()) std::abort();
    }
  }

  double Fill(int callers, int count) {
    return RateOf(callers, count, [&](int, int i) {
      jobs::NewJob job{.tenant = fmt::format("tenant-{}", i % kTenants)};
      job.request.spec = {fmt::format("kind-{}", i % 3), {{"steps", i}, {"clip", "kick.bvh"}}};
      job.request.request_id = fmt::format("request-{}", i);
      job.request.queue = i % 7 == 0 ? "slow" : "default";
      job.request.priority = i % 5 - 2;
      job.content_digest = job.request.request_id;
      if (!jobs->Submit(job).ok()) std::abort();
    });
  }

  jobs::Fence Claim(int caller, const std::string& token) {
    const auto lease = jobs->Claim({Worker(caller), token, {}, {}});
    if (!lease.ok() || !*lease) std::abort();
    return (*lease)->fence;
  }

  std::unique_ptr<jobs::JobStore> jobs;
};

Row AgainstLimit(const char* name, double value, const char* unit) {
  return {.name = name,
          .value = value,
          .unit = unit,
          .peer = fmt::format("limit: at least {:.0f} {}", kRateLimit, unit),
          .ratio = value / kRateLimit,
          .threads = kCallers};
}

Row OneCaller() {
  const DiskFolder folder;
  const double syncs = SyncsPerSecond(folder.path());
  const double rate = Store(folder.path()).Fill(1, kSubmitsOfOne);
  return {.name = "jobs/submit_one_caller",
          .value = rate,
          .unit = "submits/s",
          .peer = fmt::format("{:.0f} writes of 4 KiB with fdatasync/s on this disk", syncs),
          .ratio = rate / syncs,
          .threads = 1};
}

double CyclesPerSecond(Store& store) {
  return RateOf(kCallers, kCycles, [&](int caller, int i) {
    const jobs::Fence fence = store.Claim(caller, fmt::format("token-{}", i));
    const base::Progress progress{.step = 1, .total = 2, .message = "half way"};
    if (!store.jobs->Heartbeat(fence, progress).ok()) std::abort();
    if (!store.jobs->Finish(fence, {}).ok()) std::abort();
  });
}

// Microseconds that a claim takes while all callers claim at once, which makes them share their
// syncs. The jobs are given back, so the next round finds as many.
double ClaimRound(Store& store, int round) {
  std::vector<jobs::Fence> fences(kCallers * kClaimsOfCaller);
  const double rate = RateOf(kCallers, kCallers * kClaimsOfCaller, [&](int caller, int i) {
    fences[i] = store.Claim(caller, fmt::format("{}-{}", round, i));
  });
  RateOf(kCallers, kCallers * kClaimsOfCaller, [&](int, int i) {
    if (!store.jobs->Release(fences[i], {}).ok()) std::abort();
  });
  return 1e6 / rate;
}

// Rounds of both take turns, so that a busy machine slows both.
Row ClaimsAmongMany() {
  const DiskFolder few_folder, many_folder;
  Store few(few_folder.path()), many(many_folder.path());
  few.Fill(kCallers, kFewJobs);
  many.Fill(kCallers, kManyJobs);
  std::vector<double> few_times, many_times, ratios;
  for (int round = 0; round < kClaimRounds; ++round) {
    few_times.push_back(ClaimRound(few, round));
    many_times.push_back(ClaimRound(many, round));
    ratios.push_back(many_times.back() / few_times.back());
  }
  const double ratio = Median(ratios);
  return {.name = "jobs/claim_among_100000",
          .value = Median(many_times),
          .unit = "us",
          .peer = fmt::format("{:.1f} us among 1,000: {:.2f} times, limit: below {}",
                              Median(few_times), ratio, kClaimRatioLimit),
          .ratio = kClaimRatioLimit / ratio,
          .threads = kCallers};
}

}  // namespace

std::vector<Row> RunJobsBenchmark() {
  std::vector<Row> rows;
  {
    const DiskFolder folder;
    Store store(folder.path());
    rows.push_back(AgainstLimit("jobs/submit", store.Fill(kCallers, kSubmits), "submits/s"));
    rows.push_back(AgainstLimit("jobs/cycle", CyclesPerSecond(store), "cycles/s"));
  }
  rows.push_back(OneCaller());
  rows.push_back(ClaimsAmongMany());
  return rows;
}

}  // namespace poise::bench
