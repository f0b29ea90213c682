#ifndef POISE_CLIENT_JOB_HANDLE_H_
#define POISE_CLIENT_JOB_HANDLE_H_

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "client/job_watch.h"
#include "core/api/job.h"
#include "core/base/status.h"

namespace poise::client {

class Client;

/// A file of a job's result, in memory.
struct JobFile {
  api::JobArtifact artifact;
  std::string data;
};

/// A job on a server:
///
///   auto job = (*client)->CreateJob({.spec = {.kind = "selftest"}});
///   JobHandle handle = (*client)->Handle(job->id);
///   auto done = handle.Wait(absl::Now() + absl::Minutes(10));
///   if (done.ok() && done->state == api::JobState::kSucceeded) handle.SaveResult("out");
///
/// It holds nothing but the id: the job runs on whatever becomes of the handle. Must not outlive
/// its Client. Errors of every call: kNotFound JOB_NOT_FOUND, and those of Client.
/// Threads: all members may be called from any thread.
class JobHandle {
 public:
  JobHandle(Client& client, std::string id) : client_(&client), id_(std::move(id)) {}

  const std::string& id() const { return id_; }

  /// As it is now, with attempts and artifacts.
  StatusOr<api::Job> Get() const;

  /// Waits for the end of the job, however it ends: look at Job::state and Job::error. It watches,
  /// and does not poll. Errors: kDeadlineExceeded; the job runs on.
  StatusOr<api::Job> Wait(absl::Time deadline = absl::InfiniteFuture()) const;

  std::unique_ptr<JobWatch> Watch(const WatchOptions& options = {}) const;

  StatusOr<api::Job> Cancel() const;

  /// The files of a SUCCEEDED job, in memory, with their digests checked. Errors, here and below:
  /// kFailedPrecondition JOB_NOT_SUCCEEDED; kInternal CORRUPTED.
  StatusOr<std::vector<JobFile>> Result() const;

  /// The same as files below `folder`, which is made when absent. What is there already, whole or
  /// in part, from an earlier call is not fetched again. `only`: just the artifact of that name.
  /// Errors: kNotFound RESULT_NOT_FOUND; kFailedPrecondition CANNOT_WRITE; kInternal
  /// BAD_RESULT_NAME (it would leave the folder).
  StatusOr<std::vector<api::JobArtifact>> SaveResult(const std::filesystem::path& folder,
                                                     const std::string& only = "") const;

 private:
  StatusOr<std::vector<api::JobArtifact>> Artifacts() const;

  Client* client_;
  std::string id_;
};

}  // namespace poise::client

#endif  // POISE_CLIENT_JOB_HANDLE_H_
