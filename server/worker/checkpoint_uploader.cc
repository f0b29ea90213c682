#include "server/worker/checkpoint_uploader.h"

#include <utility>

#include "core/base/fail_point.h"
#include "server/log.h"
#include "server/worker/persistence.h"

namespace poise::worker {

CheckpointUploader::CheckpointUploader(WorkerClient& client, LeaseKeeper& keeper, jobs::Fence fence)
    : client_(client), keeper_(keeper), fence_(std::move(fence)), thread_([this] { Run(); }) {}

CheckpointUploader::~CheckpointUploader() {
  {
    std::lock_guard lock(mutex_);
    waiting_.reset();
    done_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

Status CheckpointUploader::Submit(std::string bytes, int64_t step) {
  if (keeper_.lost()) {
    return base::MakeError(absl::StatusCode::kAborted, "LEASE_LOST", "",
                           "another worker has the job");
  }
  std::lock_guard lock(mutex_);
  waiting_ = {std::move(bytes), step};
  changed_.notify_all();
  return absl::OkStatus();
}

void CheckpointUploader::Flush(absl::Duration limit) {
  constexpr absl::Duration kLook = absl::Milliseconds(50);  // at the lease
  std::unique_lock lock(mutex_);
  for (; (waiting_ || storing_) && !keeper_.lost() && limit > absl::ZeroDuration();
       limit -= kLook) {
    changed_.wait_for(lock, absl::ToChronoNanoseconds(kLook));
  }
}

bool CheckpointUploader::Overtaken() const {
  std::lock_guard lock(mutex_);
  return waiting_ || done_ || keeper_.lost();
}

void CheckpointUploader::Run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return done_ || waiting_; });
    if (done_) return;
    const Checkpoint checkpoint = *std::exchange(waiting_, std::nullopt);
    storing_ = true;
    lock.unlock();
    const Status status = Store(checkpoint);
    keeper_.Learn(status);
    if (!status.ok()) {
      server::Log(server::level::warn, "checkpoint_not_stored",
                  {{"job", fence_.job},
                   {"attempt", fence_.attempt},
                   {"step", checkpoint.step},
                   {"reason", base::ErrorReason(status)},
                   {"message", base::Message(status)}});
    }
    lock.lock();
    storing_ = false;
    changed_.notify_all();
  }
}

Status CheckpointUploader::Store(const Checkpoint& checkpoint) {
  const auto overtaken = [this] { return Overtaken(); };
  POISE_ASSIGN_OR_RETURN(const std::string artifact,
                         Persist([&] { return client_.Upload(checkpoint.bytes); }, overtaken));
  base::FailPoint("worker.before_checkpoint_commit");
  return Persist([&] { return client_.CommitCheckpoint(fence_, artifact, checkpoint.step); },
                 overtaken);
}

}  // namespace poise::worker
