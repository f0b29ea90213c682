#include "server/handlers/model_handler.h"

#include <string>
#include <utility>

#include "google/protobuf/empty.pb.h"
#include "proto/convert/model_convert.h"

namespace poise::server {
namespace {

StatusOr<v1::Model> Message(const StatusOr<api::Model>& model) {
  POISE_RETURN_IF_ERROR(model.status());
  return convert::ToProto(*model);
}

}  // namespace

ModelHandler::ModelHandler(engine::ModelCatalog& models, Admission& admission,
                           const MethodPolicies& policies)
    : models_(models), policy_(policies.model), unary_(admission, files_) {}

grpc::ServerUnaryReactor* ModelHandler::ListModels(grpc::CallbackServerContext* context,
                                                   const grpc::ByteBuffer* request,
                                                   grpc::ByteBuffer* response) {
  return unary_.Answer<v1::ListModelsRequest>(
      {context, request, response}, policy_,
      [this](const v1::ListModelsRequest&, const Call&) -> StatusOr<v1::ListModelsResponse> {
        v1::ListModelsResponse list;
        for (const api::Model& model : models_.List()) {
          *list.add_models() = convert::ToProto(model);
        }
        return list;
      });
}

grpc::ServerUnaryReactor* ModelHandler::GetModel(grpc::CallbackServerContext* context,
                                                 const grpc::ByteBuffer* request,
                                                 grpc::ByteBuffer* response) {
  return unary_.Answer<v1::GetModelRequest>(
      {context, request, response}, policy_,
      [this](const v1::GetModelRequest& message, const Call&) -> StatusOr<v1::Model> {
        return Message(models_.Get(message.model()));
      });
}

grpc::ServerUnaryReactor* ModelHandler::ImportModel(grpc::CallbackServerContext* context,
                                                    const grpc::ByteBuffer* request,
                                                    grpc::ByteBuffer* response) {
  return unary_.Answer<v1::ImportModelRequest>(
      {context, request, response}, policy_,
      [this](const v1::ImportModelRequest& message, const Call&) -> StatusOr<v1::Model> {
        return Message(models_.Import(message.name(), message.artifact()));
      });
}

grpc::ServerUnaryReactor* ModelHandler::ExportModel(grpc::CallbackServerContext* context,
                                                    const grpc::ByteBuffer* request,
                                                    grpc::ByteBuffer* response) {
  return unary_.Answer<v1::ExportModelRequest>(
      {context, request, response}, policy_,
      [this](const v1::ExportModelRequest& message, const Call&) -> StatusOr<v1::Artifact> {
        POISE_ASSIGN_OR_RETURN(const artifacts::ArtifactInfo info, models_.Export(message.model()));
        v1::Artifact artifact;
        artifact.set_name(info.name);
        artifact.set_size_bytes(info.size_bytes);
        return artifact;
      });
}

grpc::ServerUnaryReactor* ModelHandler::SetDefaultModel(grpc::CallbackServerContext* context,
                                                        const grpc::ByteBuffer* request,
                                                        grpc::ByteBuffer* response) {
  return unary_.Answer<v1::SetDefaultModelRequest>(
      {context, request, response}, policy_,
      [this](const v1::SetDefaultModelRequest& message, const Call&) -> StatusOr<v1::Model> {
        return Message(models_.SetDefault(message.model()));
      });
}

grpc::ServerUnaryReactor* ModelHandler::DeleteModel(grpc::CallbackServerContext* context,
                                                    const grpc::ByteBuffer* request,
                                                    grpc::ByteBuffer* response) {
  return unary_.Answer<v1::DeleteModelRequest>(
      {context, request, response}, policy_,
      [this](const v1::DeleteModelRequest& message,
             const Call&) -> StatusOr<google::protobuf::Empty> {
        POISE_RETURN_IF_ERROR(models_.Delete(message.model()));
        return google::protobuf::Empty();
      });
}

}  // namespace poise::server
