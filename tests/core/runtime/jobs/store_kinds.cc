#include "core/runtime/jobs/sqlite_job_store.h"
#include "tests/core/runtime/jobs/job_store_fixture.h"

namespace poise::testing {
namespace {

StatusOr<std::unique_ptr<jobs::JobStore>> OpenSqlite(const std::filesystem::path& folder,
                                                     const jobs::JobPolicy& policy,
                                                     std::function<absl::Time()> clock) {
  return jobs::OpenSqliteJobStore(
      {.path = folder / "jobs.db", .policy = policy, .clock = std::move(clock)});
}

}  // namespace

const std::vector<StoreKind>& StoreKinds() {
  static const std::vector<StoreKind> kinds = {{"sqlite", &OpenSqlite}};
  return kinds;
}

std::string NameOfKind(const ::testing::TestParamInfo<StoreKind>& info) { return info.param.name; }

}  // namespace poise::testing
