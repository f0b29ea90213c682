#include "core/runtime/jobs/sqlite_job_store.h"
#include "tests/core/runtime/jobs/job_store_fixture.h"

namespace poise::testing {
namespace {

StatusOr<std::unique_ptr<jobs::JobStore>> Open(const std::filesystem::path& folder,
                                               const jobs::JobPolicy& policy,
                                               std::function<absl::Time()> clock) {
  return jobs::OpenSqliteJobStore(
      {.path = folder / "jobs.db", .policy = policy, .clock = std::move(clock)});
}

INSTANTIATE_TEST_SUITE_P(Sqlite, JobStoreTest, ::testing::Values(StoreKind{"sqlite", &Open}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace poise::testing
