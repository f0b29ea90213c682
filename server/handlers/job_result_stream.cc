#include "server/handlers/job_result_stream.h"

#include <algorithm>
#include <utility>

#include "proto/convert/job_convert.h"
#include "server/handlers/wire.h"

namespace poise::server {
namespace {

// Chunks that may wait for a slow reader.
constexpr int kWindow = 2;

}  // namespace

JobResultStream::JobResultStream(Setup setup, grpc::ByteBuffer request, engine::JobManager& jobs,
                                 artifacts::ArtifactStore& artifacts)
    : MessageStream(std::move(setup)),
      request_(std::move(request)),
      jobs_(jobs),
      artifacts_(artifacts) {}

grpc::ServerWriteReactor<grpc::ByteBuffer>* JobResultStream::Start(
    grpc::CallbackServerContext* context, std::unique_ptr<Call> call,
    const grpc::ByteBuffer& request, engine::JobManager& jobs, artifacts::ArtifactStore& artifacts,
    base::ThreadPool& pool) {
  return MessageStream::Start(std::make_shared<JobResultStream>(
      MessageStream::Setup{context, std::move(call), &pool, &pool, kWindow}, request, jobs,
      artifacts));
}

StatusOr<int64_t> JobResultStream::Prepare(const base::RunContext&) {
  POISE_ASSIGN_OR_RETURN(const v1::GetJobResultRequest request,
                         Parse<v1::GetJobResultRequest>(std::move(request_)));
  POISE_ASSIGN_OR_RETURN(const std::string id, convert::JobId(request.name()));
  POISE_ASSIGN_OR_RETURN(files_, jobs_.Result(call().tenant(), id, request.artifact()));
  int64_t chunks = 0;
  for (api::JobArtifact& file : files_) {
    // The store's word counts: a worker may have told another size.
    POISE_ASSIGN_OR_RETURN(const artifacts::ArtifactInfo info, artifacts_.Get(file.artifact));
    file.size_bytes = info.size_bytes;
    first_chunk_.push_back(chunks);
    chunks += std::max<int64_t>((info.size_bytes + kChunkBytes - 1) / kChunkBytes, 1);
  }
  return chunks;
}

StatusOr<grpc::ByteBuffer> JobResultStream::Make(int64_t ordinal, const base::RunContext&) {
  const auto after = std::upper_bound(first_chunk_.begin(), first_chunk_.end(), ordinal);
  const size_t index = after - first_chunk_.begin() - 1;
  const int64_t chunk = ordinal - first_chunk_[index];
  v1::JobResultChunk message;
  if (chunk == 0) *message.mutable_artifact() = convert::ToProto(files_[index]);
  POISE_ASSIGN_OR_RETURN(std::string bytes,
                         artifacts_.Read(files_[index].artifact, chunk * kChunkBytes, kChunkBytes));
  message.set_chunk(std::move(bytes));
  return Serialize(message);
}

}  // namespace poise::server
