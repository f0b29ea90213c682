#ifndef POISE_SERVER_WORKER_CHECKPOINT_UPLOADER_H_
#define POISE_SERVER_WORKER_CHECKPOINT_UPLOADER_H_

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "absl/time/time.h"
#include "core/runtime/jobs/job_store.h"
#include "server/worker/lease_keeper.h"
#include "server/worker/worker_client.h"

namespace poise::worker {

/// Makes checkpoints durable beside the work: uploads each, then moves the job's pointer to it. A
/// newer one takes the place of one that still waits.
/// Threads: all members may be called from any thread.
class CheckpointUploader {
 public:
  /// Both must outlive it.
  CheckpointUploader(WorkerClient& client, LeaseKeeper& keeper, jobs::Fence fence);
  /// What waits is dropped.
  ~CheckpointUploader();
  CheckpointUploader(const CheckpointUploader&) = delete;
  CheckpointUploader& operator=(const CheckpointUploader&) = delete;

  /// Errors: kAborted LEASE_LOST.
  Status Submit(std::string bytes, int64_t step);
  /// Waits until nothing waits, the lease is lost, or `limit` is over.
  void Flush(absl::Duration limit);

 private:
  struct Checkpoint {
    std::string bytes;
    int64_t step = 0;
  };

  void Run();
  Status Store(const Checkpoint& checkpoint);
  // Another one, or the end, is more urgent than repeating a call for this one.
  bool Overtaken() const;

  WorkerClient& client_;
  LeaseKeeper& keeper_;
  const jobs::Fence fence_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Checkpoint> waiting_;
  bool storing_ = false;
  bool done_ = false;
  std::thread thread_;
};

}  // namespace poise::worker

#endif  // POISE_SERVER_WORKER_CHECKPOINT_UPLOADER_H_
