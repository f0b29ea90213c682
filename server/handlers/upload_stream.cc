#include "server/handlers/upload_stream.h"

#include <fmt/format.h>

#include <utility>

#include "proto/convert/status_convert.h"
#include "server/handlers/artifact_handler.h"
#include "server/handlers/guard.h"
#include "server/handlers/wire.h"

namespace poise::server {

UploadStream::UploadStream(grpc::CallbackServerContext* context, std::unique_ptr<Call> call,
                           grpc::ByteBuffer* response, artifacts::ArtifactStore& store,
                           base::ThreadPool& files)
    : context_(context),
      call_(std::move(call)),
      response_(response),
      store_(store),
      files_(files) {}

grpc::ServerReadReactor<grpc::ByteBuffer>* UploadStream::Start(
    std::shared_ptr<UploadStream> stream) {
  UploadStream* reactor = stream.get();
  reactor->self_ = stream;
  reactor->deadline_alarm_.Set(absl::ToChronoTime(reactor->call_->run().deadline),
                               [weak = std::weak_ptr(stream)](bool expired) {
                                 if (auto self = weak.lock(); self && expired) self->Expire();
                               });
  reactor->StartRead(&reactor->chunk_);
  return reactor;
}

void UploadStream::OnReadDone(bool ok) {
  files_.Submit([self = shared_from_this(), ok] {
    const Status status = Guarded(*self->call_, [&]() -> Status {
      POISE_RETURN_IF_ERROR(self->call_->run().Check());
      return ok ? self->StoreChunk() : self->Commit();
    });
    if (!ok || !status.ok()) return self->End(status);
    self->StartRead(&self->chunk_);
  });
}

Status UploadStream::StoreChunk() {
  POISE_ASSIGN_OR_RETURN(const v1::UploadRequest request,
                         Parse<v1::UploadRequest>(std::move(chunk_)));
  chunk_.Clear();
  if (request.chunk().size() > ArtifactHandler::kChunkBytes) {
    return base::InvalidArgument("CHUNK_TOO_LARGE", "chunk",
                                 fmt::format("a chunk has {} bytes, at most {} expected",
                                             request.chunk().size(), ArtifactHandler::kChunkBytes));
  }
  if (!request.sha256().empty()) expected_sha256_ = request.sha256();
  if (writer_ == nullptr) POISE_RETURN_IF_ERROR(Open(request));
  return writer_->Append(request.chunk());
}

Status UploadStream::Open(const v1::UploadRequest& first) {
  resumable_ = !first.upload_id().empty();
  if (resumable_) {
    POISE_ASSIGN_OR_RETURN(writer_, store_.ResumeWriter(first.upload_id(), first.offset()));
  } else if (first.offset() != 0) {
    return base::InvalidArgument("BAD_UPLOAD_ID", "upload_id",
                                 "an upload can only go on behind an offset when it has an id");
  } else {
    POISE_ASSIGN_OR_RETURN(writer_, store_.NewWriter());
  }
  return absl::OkStatus();
}

Status UploadStream::Commit() {
  if (context_->IsCancelled()) {
    return base::MakeError(absl::StatusCode::kCancelled, "CANCELLED", "", "the client is gone");
  }
  if (writer_ == nullptr) {
    return base::InvalidArgument("EMPTY_UPLOAD", "chunk",
                                 "the upload ended before its first chunk");
  }
  if (resumable_ && expected_sha256_.empty()) {
    return base::InvalidArgument("MISSING_DIGEST", "sha256",
                                 "the upload ended without the digest of the whole file");
  }
  POISE_ASSIGN_OR_RETURN(const artifacts::ArtifactInfo info, writer_->Commit(expected_sha256_));
  v1::Artifact artifact;
  artifact.set_name(info.name);
  artifact.set_size_bytes(info.size_bytes);
  *response_ = Serialize(artifact);
  return absl::OkStatus();
}

void UploadStream::End(const Status& status) {
  writer_.reset();
  {
    std::lock_guard lock(mutex_);
    ended_ = true;
  }
  Finish(convert::ToGrpc(status));
}

// Work stops at the next check; a client that sends nothing has to be woken.
void UploadStream::Expire() {
  call_->Cancel();
  std::lock_guard lock(mutex_);
  if (!ended_) context_->TryCancel();
}

void UploadStream::OnDone() {
  deadline_alarm_.Cancel();
  self_.reset();
}

}  // namespace poise::server
