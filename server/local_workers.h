#ifndef POISE_SERVER_LOCAL_WORKERS_H_
#define POISE_SERVER_LOCAL_WORKERS_H_

#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "absl/time/time.h"
#include "core/engine/job_manager.h"
#include "core/runtime/jobs/child_process.h"

namespace poise::server {

struct LocalWorkersConfig {
  int slots = 1;       ///< [> 0] jobs that run at a time
  std::string server;  ///< where this server listens, "ADDR:PORT"
  std::string token;   ///< that calls must carry; empty: none
  std::string log_level = "info";
  std::filesystem::path work_dir;  ///< for files of running jobs
  absl::Duration drain = absl::Seconds(30);
  /// Before a worker that died is started again; doubled while it dies young.
  absl::Duration first_pause = absl::Milliseconds(500);
  absl::Duration longest_pause = absl::Seconds(30);
  absl::Duration young = absl::Seconds(10);
};

/// The workers of `poised --workers N`: one poise-worker with N slots, a process beside this one.
/// It is started again when it dies, and its jobs are claimable at once. It dies with this process.
/// Its log lines go to this one's log.
/// Threads: all members may be called from any thread.
class LocalWorkers {
 public:
  /// Errors: kFailedPrecondition NO_WORKER_PROGRAM when there is none beside this program.
  static StatusOr<std::unique_ptr<LocalWorkers>> Start(LocalWorkersConfig config,
                                                       engine::JobManager& jobs);
  /// Kills what still runs.
  ~LocalWorkers();
  LocalWorkers(const LocalWorkers&) = delete;
  LocalWorkers& operator=(const LocalWorkers&) = delete;

  /// The jobs are given back, with a checkpoint. The server must serve meanwhile.
  void Drain();
  /// After Drain.
  bool ended() const { return ended_; }

 private:
  enum class Stage { kWork, kDrain, kKill };

  LocalWorkers(LocalWorkersConfig config, std::string program, engine::JobManager& jobs);
  void Run();
  // One worker from its start to its end.
  void RunOne(const std::string& id);
  jobs::ChildCommand Command(const std::string& id) const;
  Stage stage() const;
  void Advance(Stage stage);

  const LocalWorkersConfig config_;
  const std::string program_;
  engine::JobManager& jobs_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Stage stage_ = Stage::kWork;
  std::atomic<bool> ended_ = false;
  std::thread thread_;  // the workers die with it
};

/// The address at which a server that listens on `address` is reached from its own machine.
std::string LoopbackAddress(const std::string& address);

}  // namespace poise::server

#endif  // POISE_SERVER_LOCAL_WORKERS_H_
