#include "core/runtime/jobs/sqlite_job_store.h"

#include <fmt/format.h>

#include <utility>

#include "core/base/fail_point.h"
#include "core/runtime/jobs/sqlite_calls.h"
#include "core/runtime/jobs/sqlite_connection.h"
#include "core/runtime/jobs/sqlite_file.h"
#include "core/runtime/jobs/sqlite_inspect.h"
#include "core/runtime/jobs/sqlite_log.h"
#include "core/runtime/jobs/sqlite_readers.h"
#include "core/runtime/jobs/sqlite_reading.h"
#include "core/runtime/jobs/sqlite_schema.h"
#include "core/runtime/jobs/sqlite_writer.h"

namespace poise::jobs {
namespace {

namespace fs = std::filesystem;
using sqlite::Connection;
using sqlite::FileBytes;
using sqlite::LogOf;
using sqlite::Transaction;

constexpr int kReapBatch = 200;
constexpr int kCollectBatch = 50;
// Larger files are checked by Diagnose only: a start must not take minutes.
constexpr int64_t kMaxCheckedBytes = int64_t{256} << 20;

class SqliteJobStore final : public JobStore {
 public:
  SqliteJobStore(SqliteStoreConfig config, sqlite::FileOwnership ownership,
                 std::unique_ptr<Connection> connection)
      : config_(std::move(config)),
        ownership_(std::move(ownership)),
        readers_(config_.path, config_.readers),
        trimmer_(config_.path, readers_),
        writer_(std::move(connection), config_.policy, config_.clock,
                [this](Connection& db) { trimmer_.AfterCommit(db); }) {}

  void SetListener(Listener listener) override { writer_.SetListener(std::move(listener)); }

  StatusOr<SubmitOutcome> Submit(const NewJob& job) override {
    return Write("store.submit", [&](Transaction& t) { return SubmitJob(t, job); });
  }

  StatusOr<api::Job> Get(const std::string& tenant, const std::string& id) override {
    return readers_.Run([&](Connection& db) { return sqlite::LoadJob(db, tenant, id); });
  }

  StatusOr<api::JobPage> List(const ListQuery& query) override {
    return readers_.Run([&](Connection& db) { return sqlite::ListJobs(db, query); });
  }

  StatusOr<api::Job> RequestCancel(const std::string& tenant, const std::string& id,
                                   const std::string& who) override {
    return Write("store.cancel", [&](Transaction& t) { return CancelJob(t, tenant, id, who); });
  }

  Status Delete(const std::string& tenant, const std::string& id) override {
    return Write("store.delete", [&](Transaction& t) { return DeleteJob(t, tenant, id); });
  }

  StatusOr<std::vector<api::JobEvent>> ReadEvents(const std::string& id, int64_t after_seq,
                                                  int limit) override {
    return readers_.Run(
        [&](Connection& db) { return sqlite::LoadEvents(db, id, after_seq, limit); });
  }

  Status UpsertWorker(const WorkerInfo& worker) override {
    return Write("store.upsert_worker",
                 [&](Transaction& t) { return sqlite::UpsertWorker(t, worker); });
  }

  StatusOr<std::optional<Lease>> Claim(const ClaimQuery& query) override {
    return Write("store.claim", [&](Transaction& t) { return ClaimJob(t, query); });
  }

  StatusOr<HeartbeatReply> Heartbeat(const Fence& fence,
                                     const std::optional<base::Progress>& progress) override {
    return Write("store.heartbeat",
                 [&](Transaction& t) { return ExtendLease(t, fence, progress); });
  }

  StatusOr<api::Job> Leased(const Fence& fence) override {
    return Write("store.leased", [&](Transaction& t) { return LeasedJob(t, fence); });
  }

  Status CommitCheckpoint(const Fence& fence, const std::string& artifact, int64_t step) override {
    return Write("store.checkpoint",
                 [&](Transaction& t) { return SaveCheckpoint(t, fence, artifact, step); });
  }

  StatusOr<api::JobState> Finish(const Fence& fence, const Outcome& outcome) override {
    return Write("store.finish", [&](Transaction& t) { return FinishAttempt(t, fence, outcome); });
  }

  Status Release(const Fence& fence, const api::JobUsage& usage) override {
    return Write("store.release", [&](Transaction& t) { return ReleaseAttempt(t, fence, usage); });
  }

  StatusOr<int64_t> Reap() override {
    POISE_ASSIGN_OR_RETURN(const int64_t leases,
                           InBatches("store.reap", kReapBatch, sqlite::ReapLeases));
    POISE_ASSIGN_OR_RETURN(const int64_t deadlines,
                           InBatches("store.reap", kReapBatch, sqlite::ReapDeadlines));
    return leases + deadlines;
  }

  StatusOr<int64_t> ExpireWorker(const std::string& worker) override {
    return Write("store.expire_worker",
                 [&](Transaction& t) { return ExpireWorkerLeases(t, worker); });
  }

  StatusOr<int64_t> CollectExpired() override {
    POISE_ASSIGN_OR_RETURN(const int64_t jobs,
                           InBatches("store.collect", kCollectBatch, sqlite::CollectJobs));
    POISE_RETURN_IF_ERROR(
        InBatches("store.collect", kCollectBatch, sqlite::CollectEvents).status());
    POISE_RETURN_IF_ERROR(Write("store.collect", sqlite::CollectWorkers));
    return jobs;
  }

  StatusOr<std::vector<std::string>> ReferencedArtifacts() override {
    return readers_.Run(sqlite::ReadReferencedArtifacts);
  }

  StatusOr<StoreStats> Stats() override {
    POISE_ASSIGN_OR_RETURN(StoreStats stats, readers_.Run([&](Connection& db) {
      return sqlite::ReadStats(db, config_.clock());
    }));
    stats.file_bytes = FileBytes(config_.path);
    stats.wal_bytes = FileBytes(LogOf(config_.path));
    return stats;
  }

  StatusOr<std::vector<WorkerInfo>> Workers() override { return readers_.Run(sqlite::ReadWorkers); }

  StatusOr<std::vector<Finding>> Diagnose() override {
    return WithOwnConnection([&](Connection& db) -> StatusOr<std::vector<Finding>> {
      db.Run("BEGIN");
      POISE_ASSIGN_OR_RETURN(auto findings,
                             sqlite::CheckStore(db, config_.policy, config_.clock()));
      findings.push_back(sqlite::CheckLog(FileBytes(LogOf(config_.path))));
      return findings;
    });
  }

  Status BackUp(const fs::path& path) override {
    return WithOwnConnection([&](Connection& db) { return sqlite::CopyStore(db, path); });
  }

 private:
  // Runs `work` in the writer's next transaction. The fail-point holds the caller, not the writer.
  template <typename Work>
  auto Write(const char* fail_point, Work work) -> std::invoke_result_t<Work, Transaction&> {
    base::FailPoint(fail_point);
    std::invoke_result_t<Work, Transaction&> result = absl::UnknownError("not run");
    POISE_RETURN_IF_ERROR(writer_.Run([&](Transaction& t) {
      result = work(t);
      return sqlite::StatusOf(result);
    }));
    return result;
  }

  // Repeats `work` until it finds less than a whole batch; others write in between.
  StatusOr<int64_t> InBatches(const char* fail_point, int batch,
                              StatusOr<int64_t> (*work)(Transaction&, int)) {
    for (int64_t total = 0;;) {
      POISE_ASSIGN_OR_RETURN(const int64_t done,
                             Write(fail_point, [&](Transaction& t) { return work(t, batch); }));
      total += done;
      if (done < batch) return total;
    }
  }

  // For what takes long: the readers stay free.
  template <typename Work>
  auto WithOwnConnection(Work work) -> std::invoke_result_t<Work, Connection&> {
    return sqlite::Caught([&] {
      Connection connection(config_.path, Connection::Mode::kRead);
      return work(connection);
    });
  }

  const SqliteStoreConfig config_;
  const sqlite::FileOwnership ownership_;
  sqlite::Readers readers_;
  sqlite::LogTrimmer trimmer_;
  sqlite::Writer writer_;
};

Status CheckFile(Connection& db, const fs::path& path) {
  if (FileBytes(path) > kMaxCheckedBytes) return absl::OkStatus();
  sqlite::Query row = db.Prepare("PRAGMA quick_check(1)");
  row.Step();
  if (row.Text(0) == "ok") return absl::OkStatus();
  return base::MakeError(
      absl::StatusCode::kDataLoss, "STORE_CORRUPT", "store",
      fmt::format("the job store '{}' is damaged: {}", path.string(), row.Text(0)));
}

}  // namespace

StatusOr<std::unique_ptr<JobStore>> OpenSqliteJobStore(SqliteStoreConfig config) {
  POISE_ASSIGN_OR_RETURN(sqlite::FileOwnership ownership, sqlite::FileOwnership::Take(config.path));
  return sqlite::Caught([&]() -> StatusOr<std::unique_ptr<JobStore>> {
    auto connection = std::make_unique<Connection>(config.path, Connection::Mode::kWrite);
    POISE_RETURN_IF_ERROR(CheckFile(*connection, config.path));
    POISE_RETURN_IF_ERROR(sqlite::Migrate(*connection, config.policy));
    return std::make_unique<SqliteJobStore>(std::move(config), std::move(ownership),
                                            std::move(connection));
  });
}

}  // namespace poise::jobs
