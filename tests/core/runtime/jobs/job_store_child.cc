#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/base/fail_point.h"
#include "core/runtime/jobs/sqlite_job_store.h"

// A process of its own with a job store, for tests that kill it.
//
//   job_store_child FILE           opens the store, says so, and keeps it until it is killed
//   job_store_child FILE N PREFIX  makes jobs PREFIX-0 to PREFIX-(N - 1) and names each when it is
//                                  acknowledged
namespace {

void Say(const std::string& line) {
  std::puts(line.c_str());
  std::fflush(stdout);
}

int Submit(poise::jobs::JobStore& store, int count, const std::string& prefix) {
  for (int i = 0; i < count; ++i) {
    poise::jobs::NewJob job;
    job.request.spec.kind = "selftest";
    job.request.request_id = fmt::format("{}-{}", prefix, i);
    const auto outcome = store.Submit(job);
    if (!outcome.ok()) return 3;
    Say(job.request.request_id);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  poise::base::SetFailPointsFromEnvironment();
  const auto store = poise::jobs::OpenSqliteJobStore({.path = argv[1]});
  if (!store.ok()) {
    Say(poise::base::ErrorReason(store.status()));
    return 2;
  }
  if (argc == 4) return Submit(**store, std::atoi(argv[2]), argv[3]);
  Say("open");
  for (;;) pause();
}
