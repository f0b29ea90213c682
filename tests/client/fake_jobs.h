#ifndef POISE_TESTS_CLIENT_FAKE_JOBS_H_
#define POISE_TESTS_CLIENT_FAKE_JOBS_H_

#include <grpcpp/server.h>

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/api/job.h"
#include "poise/v1/artifact_service.grpc.pb.h"
#include "poise/v1/job_service.grpc.pb.h"

namespace poise::testing {

/// Jobs in memory that change when the test says so, with streams that break when it says so.
/// Threads: any.
class FakeJobs : public v1::JobService::Service {
 public:
  /// How the next watches break: each entry is for one call of WatchJob, which ends with this
  /// status after this many events.
  struct Cut {
    int events;
    grpc::Status status;
  };
  std::vector<Cut> cuts;
  /// How the next unary calls fail, after they have done what they were asked.
  std::vector<grpc::Status> lost_answers;

  // What was asked.
  std::vector<v1::CreateJobRequest> creates;
  std::vector<int64_t> joins;  ///< after_seq of each WatchJob
  std::vector<std::string> tenants;
  int gets = 0;

  std::string Add(api::JobState state);
  void SetState(const std::string& id, api::JobState state, absl::StatusCode code = {});
  void SetProgress(const std::string& id, int64_t step, int64_t total);
  void SetArtifacts(const std::string& id, std::vector<api::JobArtifact> artifacts);

  grpc::Status CreateJob(grpc::ServerContext*, const v1::CreateJobRequest*, v1::Job*) override;
  grpc::Status GetJob(grpc::ServerContext*, const v1::GetJobRequest*, v1::Job*) override;
  grpc::Status ListJobs(grpc::ServerContext*, const v1::ListJobsRequest*,
                        v1::ListJobsResponse*) override;
  grpc::Status CancelJob(grpc::ServerContext*, const v1::CancelJobRequest*, v1::Job*) override;
  grpc::Status RetryJob(grpc::ServerContext*, const v1::RetryJobRequest*, v1::Job*) override;
  grpc::Status DeleteJob(grpc::ServerContext*, const v1::DeleteJobRequest*,
                         google::protobuf::Empty*) override;
  grpc::Status WatchJob(grpc::ServerContext* context, const v1::WatchJobRequest* request,
                        grpc::ServerWriter<v1::WatchJobResponse>* writer) override;

 private:
  struct Entry {
    api::Job job;
    std::vector<api::JobEvent> events;
  };
  // With mutex_ held.
  void Append(Entry& entry, api::JobEvent event);
  grpc::Status LoseAnswer();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, Entry> jobs_;
  int created_ = 0;  // ids count up, so that they sort
};

/// Answers what it was given under a name, and breaks downloads off.
class FakeArtifacts : public v1::ArtifactService::Service {
 public:
  std::map<std::string, std::string> contents;  ///< by name
  std::string upload;                           ///< what has arrived of the unfinished upload
  int break_uploads_after = -1;                 ///< chunks; once, with UNAVAILABLE; -1: never
  int break_downloads_after = -1;               ///< chunks, in each call
  bool corrupt = false;                         ///< keeps zeros where it was broken off
  std::vector<int64_t> offsets;                 ///< of uploads and downloads, as they came

  std::string Put(const std::string& content);

  grpc::Status Upload(grpc::ServerContext*, grpc::ServerReader<v1::UploadRequest>* reader,
                      v1::Artifact* artifact) override;
  grpc::Status GetUpload(grpc::ServerContext*, const v1::GetUploadRequest* request,
                         v1::UnfinishedUpload* unfinished) override;
  grpc::Status Download(grpc::ServerContext*, const v1::DownloadRequest* request,
                        grpc::ServerWriter<v1::DownloadResponse>* writer) override;
};

/// Both services on a port of this machine, with health.
struct FakeServer {
  FakeServer(FakeJobs& jobs, FakeArtifacts& artifacts, const std::string& address = "127.0.0.1:0");
  ~FakeServer();

  std::string address;
  std::unique_ptr<grpc::Server> server;
};

}  // namespace poise::testing

#endif  // POISE_TESTS_CLIENT_FAKE_JOBS_H_
