#ifndef POISE_SERVER_HANDLERS_JOB_RESULT_STREAM_H_
#define POISE_SERVER_HANDLERS_JOB_RESULT_STREAM_H_

#include <memory>
#include <vector>

#include "core/artifacts/artifact_store.h"
#include "core/engine/job_manager.h"
#include "poise/v1/job_service.pb.h"
#include "server/handlers/message_stream.h"

namespace poise::server {

/// The files of a job's result, one after the other in chunks. An empty file is one empty chunk.
class JobResultStream : public MessageStream {
 public:
  static constexpr int64_t kChunkBytes = 1 << 20;

  JobResultStream(Setup setup, grpc::ByteBuffer request, engine::JobManager& jobs,
                  artifacts::ArtifactStore& artifacts);

  static grpc::ServerWriteReactor<grpc::ByteBuffer>* Start(grpc::CallbackServerContext* context,
                                                           std::unique_ptr<Call> call,
                                                           const grpc::ByteBuffer& request,
                                                           engine::JobManager& jobs,
                                                           artifacts::ArtifactStore& artifacts,
                                                           base::ThreadPool& pool);

 private:
  StatusOr<int64_t> Prepare(const base::RunContext& context) override;
  StatusOr<grpc::ByteBuffer> Make(int64_t ordinal, const base::RunContext& context) override;

  grpc::ByteBuffer request_;
  engine::JobManager& jobs_;
  artifacts::ArtifactStore& artifacts_;
  std::vector<api::JobArtifact> files_;
  std::vector<int64_t> first_chunk_;  ///< of each file, among all
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_JOB_RESULT_STREAM_H_
