#include "client/job_handle.h"

#include <fmt/format.h>

#include <algorithm>

#include "client/client.h"

namespace poise::client {
namespace {

namespace fs = std::filesystem;

// A name from the server must not become a path elsewhere.
StatusOr<fs::path> PathBelow(const fs::path& folder, const std::string& name) {
  const fs::path relative(name);
  const bool leaves = relative.empty() || relative.is_absolute() ||
                      std::any_of(relative.begin(), relative.end(), [](const fs::path& part) {
                        return part == ".." || part.empty();
                      });
  if (!leaves) return folder / relative;
  return base::Internal(
      "BAD_RESULT_NAME",
      fmt::format("the result has a file '{}', which is no path below a folder", name));
}

Status MakeFolder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (!error) return absl::OkStatus();
  return base::FailedPrecondition(
      "CANNOT_WRITE", "out",
      fmt::format("{}: cannot be written: {}", path.string(), error.message()));
}

}  // namespace

StatusOr<api::Job> JobHandle::Get() const { return client_->GetJob(id_); }
StatusOr<api::Job> JobHandle::Cancel() const { return client_->CancelJob(id_); }

std::unique_ptr<JobWatch> JobHandle::Watch(const WatchOptions& options) const {
  return client_->WatchJob(id_, options);
}

StatusOr<api::Job> JobHandle::Wait(absl::Time deadline) const {
  POISE_ASSIGN_OR_RETURN(api::Job job, Get());
  if (api::IsTerminal(job.state)) return job;
  const auto watch = Watch({.after_seq = job.event_seq, .deadline = deadline});
  while (true) {
    POISE_ASSIGN_OR_RETURN(const auto event, watch->Next());
    if (!event) return Get();
  }
}

StatusOr<std::vector<api::JobArtifact>> JobHandle::Artifacts() const {
  POISE_ASSIGN_OR_RETURN(api::Job job, Get());
  if (job.state == api::JobState::kSucceeded) return std::move(job.artifacts);
  return base::FailedPrecondition("JOB_NOT_SUCCEEDED", "name",
                                  fmt::format("jobs/{} is {}, only a SUCCEEDED job has a result",
                                              id_, api::JobStateName(job.state)));
}

StatusOr<std::vector<JobFile>> JobHandle::Result() const {
  POISE_ASSIGN_OR_RETURN(const auto artifacts, Artifacts());
  std::vector<JobFile> files;
  for (const api::JobArtifact& artifact : artifacts) {
    POISE_ASSIGN_OR_RETURN(std::string data, client_->Download(artifact.artifact));
    files.push_back({artifact, std::move(data)});
  }
  return files;
}

StatusOr<std::vector<api::JobArtifact>> JobHandle::SaveResult(const fs::path& folder,
                                                              const std::string& only) const {
  POISE_ASSIGN_OR_RETURN(auto artifacts, Artifacts());
  if (!only.empty()) {
    std::erase_if(artifacts, [&](const api::JobArtifact& file) { return file.name != only; });
    if (artifacts.empty()) {
      return base::NotFound("RESULT_NOT_FOUND", "artifact",
                            fmt::format("the result of jobs/{} has no file '{}'", id_, only));
    }
  }
  for (const api::JobArtifact& artifact : artifacts) {
    POISE_ASSIGN_OR_RETURN(const fs::path path, PathBelow(folder, artifact.name));
    POISE_RETURN_IF_ERROR(MakeFolder(path.parent_path()));
    POISE_RETURN_IF_ERROR(client_->DownloadFile(artifact.artifact, path));
  }
  return artifacts;
}

}  // namespace poise::client
