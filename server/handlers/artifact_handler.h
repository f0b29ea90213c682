#ifndef POISE_SERVER_HANDLERS_ARTIFACT_HANDLER_H_
#define POISE_SERVER_HANDLERS_ARTIFACT_HANDLER_H_

#include "core/artifacts/artifact_store.h"
#include "core/base/thread_pool.h"
#include "poise/v1/artifact_service.grpc.pb.h"
#include "server/admission/admission.h"
#include "server/handlers/unary_methods.h"

namespace poise::server {

/// poise.v1.ArtifactService.
/// Threads: gRPC calls from many. Files are read and written on two threads of its own, so that a
/// slow disk holds up neither gRPC nor the computing.
class ArtifactHandler
    : public v1::ArtifactService::WithRawCallbackMethod_Upload<
          v1::ArtifactService::WithRawCallbackMethod_GetUpload<
              v1::ArtifactService::WithRawCallbackMethod_Download<v1::ArtifactService::Service>>> {
 public:
  /// The largest chunk of an upload, and the size of a download's.
  static constexpr int64_t kChunkBytes = 1 << 20;

  ArtifactHandler(artifacts::ArtifactStore& store, Admission& admission,
                  const MethodPolicies& policies);

  grpc::ServerReadReactor<grpc::ByteBuffer>* Upload(grpc::CallbackServerContext* context,
                                                    grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* GetUpload(grpc::CallbackServerContext* context,
                                      const grpc::ByteBuffer* request,
                                      grpc::ByteBuffer* response) override;
  grpc::ServerWriteReactor<grpc::ByteBuffer>* Download(grpc::CallbackServerContext* context,
                                                       const grpc::ByteBuffer* request) override;

 private:
  StatusOr<v1::UnfinishedUpload> FindUpload(const v1::GetUploadRequest& request);

  artifacts::ArtifactStore& store_;
  Admission& admission_;
  const MethodPolicies policies_;
  base::ThreadPool files_{2};
  UnaryMethods unary_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_ARTIFACT_HANDLER_H_
