#ifndef POISE_SERVER_HANDLERS_UPLOAD_STREAM_H_
#define POISE_SERVER_HANDLERS_UPLOAD_STREAM_H_

#include <grpcpp/alarm.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <memory>
#include <mutex>
#include <string>

#include "core/artifacts/artifact_store.h"
#include "core/base/thread_pool.h"
#include "poise/v1/artifact.pb.h"
#include "server/admission/admission.h"

namespace poise::server {

/// A client stream of chunks that become an artifact. The next chunk is asked for when the last one
/// is in the file, so an upload takes one chunk of memory, and a client that has handed over a
/// chunk knows that the one before it is stored. With an upload id the stream goes on where an
/// earlier one broke off. Lifetime: as MessageStream.
class UploadStream : public grpc::ServerReadReactor<grpc::ByteBuffer>,
                     public std::enable_shared_from_this<UploadStream> {
 public:
  UploadStream(grpc::CallbackServerContext* context, std::unique_ptr<Call> call,
               grpc::ByteBuffer* response, artifacts::ArtifactStore& store,
               base::ThreadPool& files);

  static grpc::ServerReadReactor<grpc::ByteBuffer>* Start(std::shared_ptr<UploadStream> stream);

 private:
  void OnReadDone(bool ok) override;
  void OnCancel() override { call_->Cancel(); }
  void OnDone() override;

  Status StoreChunk();
  Status Open(const v1::UploadRequest& first);
  Status Commit();
  void End(const Status& status);
  void Expire();

  grpc::CallbackServerContext* const context_;
  const std::unique_ptr<Call> call_;
  grpc::ByteBuffer* const response_;
  artifacts::ArtifactStore& store_;
  base::ThreadPool& files_;
  grpc::Alarm deadline_alarm_;
  std::shared_ptr<UploadStream> self_;

  // One callback at a time uses these: a read, or the task that follows it.
  grpc::ByteBuffer chunk_;
  std::unique_ptr<artifacts::ArtifactWriter> writer_;
  bool resumable_ = false;
  std::string expected_sha256_;

  std::mutex mutex_;
  bool ended_ = false;  // Finish was called: the context may go away
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_UPLOAD_STREAM_H_
