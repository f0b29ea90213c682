// What Client asks of ModelService and DataService.
#include <utility>

#include "client/client.h"
#include "client/connection.h"
#include "google/protobuf/empty.pb.h"
#include "proto/convert/data_convert.h"
#include "proto/convert/model_convert.h"

namespace poise::client {
namespace {

// One unary call with its answer.
template <typename Service, typename Request, typename Response>
StatusOr<Response> Call(const Connection& connection, typename Service::Stub& stub,
                        grpc::Status (Service::Stub::*method)(grpc::ClientContext*, const Request&,
                                                              Response*),
                        const Request& request) {
  const auto context = connection.NewCall();
  Response response;
  POISE_RETURN_IF_ERROR(connection.Explain((stub.*method)(context.get(), request, &response)));
  return response;
}

// The calls that take a model's reference.
template <typename Request, typename Response>
StatusOr<Response> ModelCall(const Connection& connection,
                             grpc::Status (v1::ModelService::Stub::*method)(grpc::ClientContext*,
                                                                            const Request&,
                                                                            Response*),
                             const std::string& model) {
  Request request;
  request.set_model(model);
  return Call<v1::ModelService>(connection, connection.model(), method, request);
}

StatusOr<api::Model> Unwrap(const StatusOr<v1::Model>& model) {
  POISE_RETURN_IF_ERROR(model.status());
  return convert::FromProto(*model);
}

StatusOr<api::DataSet> Unwrap(const StatusOr<v1::DataSet>& set) {
  POISE_RETURN_IF_ERROR(set.status());
  return convert::FromProto(*set);
}

}  // namespace

StatusOr<std::vector<api::Model>> Client::ListModels() {
  POISE_ASSIGN_OR_RETURN(
      const v1::ListModelsResponse list,
      Call<v1::ModelService>(*connection_, connection_->model(),
                             &v1::ModelService::Stub::ListModels, v1::ListModelsRequest()));
  std::vector<api::Model> models;
  for (const v1::Model& message : list.models()) {
    POISE_ASSIGN_OR_RETURN(api::Model model, convert::FromProto(message));
    models.push_back(std::move(model));
  }
  return models;
}

StatusOr<api::Model> Client::GetModel(const std::string& model) {
  return Unwrap(ModelCall(*connection_, &v1::ModelService::Stub::GetModel, model));
}

StatusOr<api::Model> Client::ImportModel(const std::string& name, const std::string& artifact) {
  v1::ImportModelRequest request;
  request.set_name(name);
  request.set_artifact(artifact);
  return Unwrap(Call<v1::ModelService>(*connection_, connection_->model(),
                                       &v1::ModelService::Stub::ImportModel, request));
}

StatusOr<StoredArtifact> Client::ExportModel(const std::string& model) {
  POISE_ASSIGN_OR_RETURN(const v1::Artifact artifact,
                         ModelCall(*connection_, &v1::ModelService::Stub::ExportModel, model));
  return StoredArtifact{.name = artifact.name(), .size_bytes = artifact.size_bytes()};
}

StatusOr<api::Model> Client::SetDefaultModel(const std::string& model) {
  return Unwrap(ModelCall(*connection_, &v1::ModelService::Stub::SetDefaultModel, model));
}

Status Client::DeleteModel(const std::string& model) {
  return ModelCall(*connection_, &v1::ModelService::Stub::DeleteModel, model).status();
}

StatusOr<api::DataSet> Client::CreateDataSet(const std::string& name, const std::string& artifact) {
  v1::CreateDataSetRequest request;
  request.set_name(name);
  request.set_artifact(artifact);
  return Unwrap(Call<v1::DataService>(*connection_, connection_->data(),
                                      &v1::DataService::Stub::CreateDataSet, request));
}

StatusOr<api::DataSet> Client::GetDataSet(const std::string& name) {
  v1::GetDataSetRequest request;
  request.set_name(name);
  return Unwrap(Call<v1::DataService>(*connection_, connection_->data(),
                                      &v1::DataService::Stub::GetDataSet, request));
}

StatusOr<std::vector<api::DataSet>> Client::ListDataSets() {
  POISE_ASSIGN_OR_RETURN(
      const v1::ListDataSetsResponse list,
      Call<v1::DataService>(*connection_, connection_->data(), &v1::DataService::Stub::ListDataSets,
                            v1::ListDataSetsRequest()));
  std::vector<api::DataSet> sets;
  for (const v1::DataSet& message : list.data_sets()) sets.push_back(convert::FromProto(message));
  return sets;
}

Status Client::DeleteDataSet(const std::string& name) {
  v1::DeleteDataSetRequest request;
  request.set_name(name);
  return Call<v1::DataService>(*connection_, connection_->data(),
                               &v1::DataService::Stub::DeleteDataSet, request)
      .status();
}

}  // namespace poise::client
