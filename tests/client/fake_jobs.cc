#include "tests/client/fake_jobs.h"

#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/server_builder.h>

#include <algorithm>

#include "absl/time/clock.h"
#include "core/base/sha256.h"
#include "proto/convert/job_convert.h"
#include "proto/convert/status_convert.h"

namespace poise::testing {
namespace {

constexpr size_t kDownloadChunk = 100'000;

grpc::Status NotFound() {
  return convert::ToGrpc(base::NotFound("JOB_NOT_FOUND", "name", "there is no such job"));
}

}  // namespace

std::string FakeJobs::Add(api::JobState state) {
  std::lock_guard lock(mutex_);
  api::Job job;
  job.id = std::to_string(1000'000 + ++created_);
  job.spec.kind = "selftest";
  job.create_time = absl::Now();
  Entry& entry = jobs_[job.id];
  entry.job = job;
  Append(entry, {.state = state});
  return job.id;
}

void FakeJobs::Append(Entry& entry, api::JobEvent event) {
  event.seq = ++entry.job.event_seq;
  event.time = absl::Now();
  if (event.state) {
    entry.job.state = *event.state;
    entry.job.error = event.error;
  }
  if (event.progress) entry.job.progress = *event.progress;
  entry.events.push_back(event);
  changed_.notify_all();
}

void FakeJobs::SetState(const std::string& id, api::JobState state, absl::StatusCode code) {
  std::lock_guard lock(mutex_);
  api::JobEvent event{.state = state};
  if (code != absl::StatusCode::kOk) {
    event.error =
        api::JobError{.code = code, .reason = "TOLD_TO", .message = "it was told to", .field = ""};
  }
  Append(jobs_[id], event);
}

void FakeJobs::SetProgress(const std::string& id, int64_t step, int64_t total) {
  std::lock_guard lock(mutex_);
  Append(jobs_[id], {.progress = base::Progress{.step = step, .total = total, .message = ""}});
}

void FakeJobs::SetArtifacts(const std::string& id, std::vector<api::JobArtifact> artifacts) {
  std::lock_guard lock(mutex_);
  jobs_[id].job.artifacts = std::move(artifacts);
}

grpc::Status FakeJobs::LoseAnswer() {
  if (lost_answers.empty()) return grpc::Status::OK;
  const grpc::Status status = lost_answers.front();
  lost_answers.erase(lost_answers.begin());
  return status;
}

grpc::Status FakeJobs::CreateJob(grpc::ServerContext* context, const v1::CreateJobRequest* request,
                                 v1::Job* answer) {
  std::lock_guard lock(mutex_);
  creates.push_back(*request);
  const auto tenant = context->client_metadata().find("x-poise-tenant");
  if (tenant != context->client_metadata().end()) {
    tenants.emplace_back(tenant->second.data(), tenant->second.size());
  }
  for (const auto& [id, entry] : jobs_) {
    if (entry.job.request_id == request->request_id()) {
      *answer = convert::ToProto(entry.job);
      return LoseAnswer();
    }
  }
  api::Job job;
  job.id = std::to_string(1000'000 + ++created_);
  job.spec = *convert::FromProto(request->spec());
  job.request_id = request->request_id();
  job.create_time = absl::Now();
  jobs_[job.id].job = job;
  Append(jobs_[job.id], {.state = api::JobState::kQueued});
  *answer = convert::ToProto(jobs_[job.id].job);
  return LoseAnswer();
}

grpc::Status FakeJobs::GetJob(grpc::ServerContext*, const v1::GetJobRequest* request,
                              v1::Job* answer) {
  std::lock_guard lock(mutex_);
  ++gets;
  const auto found = jobs_.find(*convert::JobId(request->name()));
  if (found == jobs_.end()) return NotFound();
  *answer = convert::ToProto(found->second.job);
  return LoseAnswer();
}

// In pages of two; the token is the number of jobs that have been given.
grpc::Status FakeJobs::ListJobs(grpc::ServerContext*, const v1::ListJobsRequest* request,
                                v1::ListJobsResponse* answer) {
  std::lock_guard lock(mutex_);
  const auto filter = api::JobFilter::Parse(request->filter());
  if (!filter.ok()) return convert::ToGrpc(filter.status());
  size_t skip = request->page_token().empty() ? 0 : std::stoul(request->page_token());
  const size_t end = skip + std::clamp(request->page_size(), 1, 2);
  size_t number = 0;
  for (auto entry = jobs_.rbegin(); entry != jobs_.rend(); ++entry) {
    const api::Job& job = entry->second.job;
    if (filter->state && *filter->state != job.state) continue;
    if (!filter->kind.empty() && filter->kind != job.spec.kind) continue;
    if (number >= skip && number < end) *answer->add_jobs() = convert::ToProto(job);
    if (number++ == end) answer->set_next_page_token(std::to_string(end));
  }
  return grpc::Status::OK;
}

grpc::Status FakeJobs::CancelJob(grpc::ServerContext*, const v1::CancelJobRequest* request,
                                 v1::Job* answer) {
  std::lock_guard lock(mutex_);
  const auto found = jobs_.find(*convert::JobId(request->name()));
  if (found == jobs_.end()) return NotFound();
  if (!api::IsTerminal(found->second.job.state)) {
    Append(found->second, {.state = api::JobState::kCancelled});
  }
  *answer = convert::ToProto(found->second.job);
  return LoseAnswer();
}

grpc::Status FakeJobs::RetryJob(grpc::ServerContext*, const v1::RetryJobRequest* request,
                                v1::Job* answer) {
  std::lock_guard lock(mutex_);
  const auto found = jobs_.find(*convert::JobId(request->name()));
  if (found == jobs_.end()) return NotFound();
  api::Job job;
  job.id = std::to_string(1000'000 + ++created_);
  job.spec = found->second.job.spec;
  job.request_id = request->request_id();
  job.retry_of = found->second.job.id;
  job.create_time = absl::Now();
  jobs_[job.id].job = job;
  Append(jobs_[job.id], {.state = api::JobState::kQueued});
  *answer = convert::ToProto(jobs_[job.id].job);
  return LoseAnswer();
}

grpc::Status FakeJobs::DeleteJob(grpc::ServerContext*, const v1::DeleteJobRequest* request,
                                 google::protobuf::Empty*) {
  std::lock_guard lock(mutex_);
  if (jobs_.erase(*convert::JobId(request->name())) == 0) return NotFound();
  return LoseAnswer();
}

grpc::Status FakeJobs::WatchJob(grpc::ServerContext* context, const v1::WatchJobRequest* request,
                                grpc::ServerWriter<v1::WatchJobResponse>* writer) {
  std::unique_lock lock(mutex_);
  joins.push_back(request->after_seq());
  const auto found = jobs_.find(*convert::JobId(request->name()));
  if (found == jobs_.end()) return NotFound();
  Cut cut{.events = 1'000'000, .status = grpc::Status::OK};
  if (!cuts.empty()) {
    cut = cuts.front();
    cuts.erase(cuts.begin());
  }
  v1::WatchJobResponse response;
  *response.mutable_snapshot() = convert::ToProto(found->second.job);
  writer->Write(response);
  const std::vector<api::JobEvent>& events = found->second.events;
  size_t next = request->after_seq();
  for (int sent = 0;; ++sent) {
    if (sent >= cut.events) return cut.status;
    while (next >= events.size()) {
      if (next > 0 && events.back().state && api::IsTerminal(*events.back().state))
        return grpc::Status::OK;
      if (context->IsCancelled()) return grpc::Status::CANCELLED;
      changed_.wait_for(lock, std::chrono::milliseconds(5));
    }
    *response.mutable_event() = convert::ToProto(events[next++]);
    writer->Write(response);
  }
}

std::string FakeArtifacts::Put(const std::string& content) {
  const std::string name = "artifacts/" + base::Sha256Hex(content);
  contents[name] = content;
  return name;
}

grpc::Status FakeArtifacts::Upload(grpc::ServerContext*,
                                   grpc::ServerReader<v1::UploadRequest>* reader,
                                   v1::Artifact* artifact) {
  v1::UploadRequest request;
  std::string sha256;
  int chunks = 0;
  for (bool first = true; reader->Read(&request); first = false) {
    if (first) {
      offsets.push_back(request.offset());
      upload.resize(request.offset());
    }
    if (break_uploads_after >= 0 && chunks == break_uploads_after) {
      break_uploads_after = -1;
      if (corrupt) std::fill(upload.begin(), upload.end(), '\0');
      return {grpc::StatusCode::UNAVAILABLE, "Socket closed"};
    }
    if (!request.chunk().empty()) ++chunks;
    upload += request.chunk();
    sha256 = request.sha256();
  }
  if (sha256 != base::Sha256Hex(upload)) {
    upload.clear();
    return convert::ToGrpc(base::InvalidArgument("WRONG_DIGEST", "sha256", "not what was sent"));
  }
  artifact->set_name(Put(upload));
  artifact->set_size_bytes(static_cast<int64_t>(upload.size()));
  upload.clear();
  return grpc::Status::OK;
}

grpc::Status FakeArtifacts::GetUpload(grpc::ServerContext*, const v1::GetUploadRequest* request,
                                      v1::UnfinishedUpload* unfinished) {
  unfinished->set_received_bytes(static_cast<int64_t>(upload.size()));
  const auto stored = contents.find("artifacts/" + request->sha256());
  if (stored != contents.end()) {
    unfinished->mutable_artifact()->set_name(stored->first);
    unfinished->mutable_artifact()->set_size_bytes(static_cast<int64_t>(stored->second.size()));
  }
  return grpc::Status::OK;
}

grpc::Status FakeArtifacts::Download(grpc::ServerContext*, const v1::DownloadRequest* request,
                                     grpc::ServerWriter<v1::DownloadResponse>* writer) {
  const std::string& content = contents[request->name()];
  offsets.push_back(request->offset());
  if (request->offset() > static_cast<int64_t>(content.size())) {
    return convert::ToGrpc(base::InvalidArgument("BAD_OFFSET", "offset", "behind the end"));
  }
  int chunks = 0;
  for (size_t at = request->offset(); at < content.size(); at += kDownloadChunk) {
    if (chunks++ == break_downloads_after) return {grpc::StatusCode::UNAVAILABLE, "Socket closed"};
    v1::DownloadResponse response;
    response.set_chunk(content.substr(at, kDownloadChunk));
    writer->Write(response);
  }
  return grpc::Status::OK;
}

FakeServer::FakeServer(FakeJobs& jobs, FakeArtifacts& artifacts, const std::string& listen) {
  grpc::EnableDefaultHealthCheckService(true);
  grpc::ServerBuilder builder;
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  int port = 0;
  builder.AddListeningPort(listen, grpc::InsecureServerCredentials(), &port);
  builder.RegisterService(&jobs);
  builder.RegisterService(&artifacts);
  server = builder.BuildAndStart();
  address = "127.0.0.1:" + std::to_string(port);
}

FakeServer::~FakeServer() { server->Shutdown(std::chrono::system_clock::now()); }

}  // namespace poise::testing
