#include "server/handlers/artifact_handler.h"

#include <utility>

#include "core/artifacts/artifact_name.h"
#include "server/handlers/message_stream.h"
#include "server/handlers/refusal.h"
#include "server/handlers/upload_stream.h"
#include "server/handlers/wire.h"

namespace poise::server {
namespace {

// Chunks that may wait for a slow reader.
constexpr int kWindow = 2;

class DownloadStream : public MessageStream {
 public:
  DownloadStream(Setup setup, grpc::ByteBuffer request, artifacts::ArtifactStore& store)
      : MessageStream(std::move(setup)), bytes_(std::move(request)), store_(store) {}

 private:
  StatusOr<int64_t> Prepare(const base::RunContext&) override {
    POISE_ASSIGN_OR_RETURN(request_, Parse<v1::DownloadRequest>(std::move(bytes_)));
    POISE_ASSIGN_OR_RETURN(const artifacts::ArtifactInfo info, store_.Get(request_.name()));
    // Reading nothing checks the offset.
    POISE_RETURN_IF_ERROR(store_.Read(request_.name(), request_.offset(), 0).status());
    const int64_t wanted = info.size_bytes - request_.offset();
    return (wanted + ArtifactHandler::kChunkBytes - 1) / ArtifactHandler::kChunkBytes;
  }

  StatusOr<grpc::ByteBuffer> Make(int64_t ordinal, const base::RunContext&) override {
    const int64_t offset = request_.offset() + ordinal * ArtifactHandler::kChunkBytes;
    POISE_ASSIGN_OR_RETURN(std::string chunk,
                           store_.Read(request_.name(), offset, ArtifactHandler::kChunkBytes));
    v1::DownloadResponse response;
    response.set_chunk(std::move(chunk));
    return Serialize(response);
  }

  grpc::ByteBuffer bytes_;
  artifacts::ArtifactStore& store_;
  v1::DownloadRequest request_;
};

}  // namespace

ArtifactHandler::ArtifactHandler(artifacts::ArtifactStore& store, Admission& admission,
                                 const MethodPolicies& policies)
    : store_(store), admission_(admission), policies_(policies), unary_(admission, files_) {}

grpc::ServerReadReactor<grpc::ByteBuffer>* ArtifactHandler::Upload(
    grpc::CallbackServerContext* context, grpc::ByteBuffer* response) {
  StatusOr<std::unique_ptr<Call>> call = admission_.Admit(*context, policies_.upload);
  if (!call.ok()) return new Refusal<grpc::ServerReadReactor<grpc::ByteBuffer>>(call.status());
  return UploadStream::Start(
      std::make_shared<UploadStream>(context, *std::move(call), response, store_, files_));
}

grpc::ServerUnaryReactor* ArtifactHandler::GetUpload(grpc::CallbackServerContext* context,
                                                     const grpc::ByteBuffer* request,
                                                     grpc::ByteBuffer* response) {
  return unary_.Answer<v1::GetUploadRequest>(
      {context, request, response}, policies_.get_upload,
      [this](const v1::GetUploadRequest& message, const Call&) { return FindUpload(message); });
}

StatusOr<v1::UnfinishedUpload> ArtifactHandler::FindUpload(const v1::GetUploadRequest& request) {
  v1::UnfinishedUpload upload;
  POISE_ASSIGN_OR_RETURN(const int64_t received, store_.ReceivedBytes(request.upload_id()));
  upload.set_received_bytes(received);
  if (request.sha256().empty()) return upload;
  const StatusOr<artifacts::ArtifactInfo> stored =
      store_.Refresh(artifacts::ArtifactName(request.sha256()));
  if (stored.ok()) {
    upload.mutable_artifact()->set_name(stored->name);
    upload.mutable_artifact()->set_size_bytes(stored->size_bytes);
  } else if (stored.status().code() != absl::StatusCode::kNotFound) {
    return stored.status();
  }
  return upload;
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* ArtifactHandler::Download(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  StatusOr<std::unique_ptr<Call>> call = admission_.Admit(*context, policies_.download);
  if (!call.ok()) return new Refusal<grpc::ServerWriteReactor<grpc::ByteBuffer>>(call.status());
  return MessageStream::Start(std::make_shared<DownloadStream>(
      MessageStream::Setup{context, *std::move(call), &files_, &files_, kWindow}, *request,
      store_));
}

}  // namespace poise::server
