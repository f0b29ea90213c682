#ifndef POISE_CORE_RUNTIME_JOBS_SQLITE_WRITER_H_
#define POISE_CORE_RUNTIME_JOBS_SQLITE_WRITER_H_

#include <condition_variable>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/runtime/jobs/job_store.h"
#include "core/runtime/jobs/sqlite_connection.h"

namespace poise::jobs::sqlite {

/// What one call sees while it writes.
struct Transaction {
  Connection& db;
  const JobPolicy& policy;
  absl::Time now;  ///< whole milliseconds

  // Told to the listener after the commit.
  std::vector<Transition> transitions = {};
  std::vector<std::string> jobs_with_news = {};  ///< ids
};

/// The only one that writes. A commit waits for the disk, and meanwhile more calls arrive: all
/// that wait go into the next transaction together, each behind a savepoint of its own, so that
/// they share one sync. Nobody is answered before the commit.
class Writer {
 public:
  using Work = std::function<Status(Transaction&)>;

  /// `after_commit` is called when those who waited for the commit have their answers.
  Writer(std::unique_ptr<Connection> connection, const JobPolicy& policy,
         std::function<absl::Time()> clock, std::function<void(Connection&)> after_commit);
  /// Does what was asked for before.
  ~Writer();

  void SetListener(JobStore::Listener listener);

  /// Runs `work` in a transaction. When it returns an error, or throws, its writes are undone and
  /// the others' stand.
  Status Run(Work work);

 private:
  struct Call {
    Work work;
    std::promise<Status> answer = {};
    Status status = absl::OkStatus();
  };

  void Loop();
  void CommitTogether(const std::vector<std::shared_ptr<Call>>& calls);
  Status RunOne(Call& call, std::vector<Transition>& transitions, std::vector<std::string>& news);
  void Tell(const std::vector<Transition>& transitions, const std::vector<std::string>& news);

  const std::unique_ptr<Connection> connection_;
  const JobPolicy policy_;
  const std::function<absl::Time()> clock_;
  const std::function<void(Connection&)> after_commit_;

  std::mutex mutex_;
  std::condition_variable arrived_;
  std::vector<std::shared_ptr<Call>> waiting_;
  JobStore::Listener listener_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace poise::jobs::sqlite

#endif  // POISE_CORE_RUNTIME_JOBS_SQLITE_WRITER_H_
