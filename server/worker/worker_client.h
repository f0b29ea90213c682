#ifndef POISE_SERVER_WORKER_WORKER_CLIENT_H_
#define POISE_SERVER_WORKER_WORKER_CLIENT_H_

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "client/client_options.h"
#include "client/connection.h"
#include "core/runtime/jobs/job_store.h"

namespace poise::worker {

/// Ends a call from another thread.
class CallBreaker {
 public:
  /// The call that is under way ends with kCancelled, and so does every later one.
  void Break();
  bool broken() const;

 private:
  friend class WorkerClient;
  void Enter(grpc::ClientContext& context);
  void Leave();

  mutable std::mutex mutex_;
  grpc::ClientContext* context_ = nullptr;
  bool broken_ = false;
};

/// What came for a wish for a job.
struct LeaseAnswer {
  std::optional<jobs::Lease> lease;
  bool draining = false;  ///< the server goes away: ask later
};

/// The server, as a worker sees it: each call once, with a time limit.
/// Errors of every call: the server's (worker_service.proto), and those of
/// client/transport_error.h; IsDefinite tells which to take for an answer.
/// Threads: all members may be called from any thread.
class WorkerClient {
 public:
  explicit WorkerClient(client::ClientOptions options);

  /// Returns the server's heartbeat interval.
  StatusOr<absl::Duration> Register(const jobs::WorkerInfo& worker);
  /// Waits up to `wait` for a job.
  StatusOr<LeaseAnswer> LeaseJob(const jobs::ClaimQuery& query, absl::Duration wait,
                                 CallBreaker& breaker);
  /// The server may answer up to `hold` later; nobody waits longer than `limit`.
  StatusOr<jobs::HeartbeatReply> Heartbeat(const jobs::Fence& fence,
                                           const std::optional<base::Progress>& progress,
                                           absl::Duration hold, absl::Duration limit,
                                           CallBreaker& breaker);
  Status CommitCheckpoint(const jobs::Fence& fence, const std::string& artifact, int64_t step);
  StatusOr<api::JobState> Finish(const jobs::Fence& fence, const jobs::Outcome& outcome);
  Status Release(const jobs::Fence& fence, const api::JobUsage& usage);

  /// Files of the server, by their names; they are checked against these.
  StatusOr<std::string> Upload(std::string_view bytes);
  StatusOr<std::string> UploadFile(const std::filesystem::path& path);
  StatusOr<std::string> Download(const std::string& artifact);
  Status DownloadFile(const std::string& artifact, const std::filesystem::path& path);

 private:
  const client::Connection connection_;
};

/// False when the call may have failed for reasons that pass: the server is gone, restarts, or is
/// overloaded. Repeating it then does no harm.
bool IsDefinite(const Status& status);

}  // namespace poise::worker

#endif  // POISE_SERVER_WORKER_WORKER_CLIENT_H_
