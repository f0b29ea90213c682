#include "server/handlers/data_handler.h"

#include <utility>

#include "google/protobuf/empty.pb.h"
#include "proto/convert/data_convert.h"

namespace poise::server {
namespace {

StatusOr<v1::DataSet> Message(const StatusOr<api::DataSet>& set) {
  POISE_RETURN_IF_ERROR(set.status());
  return convert::ToProto(*set);
}

}  // namespace

DataHandler::DataHandler(artifacts::DataSetRegistry& data_sets, Admission& admission,
                         const MethodPolicies& policies)
    : data_sets_(data_sets), policy_(policies.data), unary_(admission, files_) {}

grpc::ServerUnaryReactor* DataHandler::CreateDataSet(grpc::CallbackServerContext* context,
                                                     const grpc::ByteBuffer* request,
                                                     grpc::ByteBuffer* response) {
  return unary_.Answer<v1::CreateDataSetRequest>(
      {context, request, response}, policy_,
      [this](const v1::CreateDataSetRequest& message, const Call&) -> StatusOr<v1::DataSet> {
        return Message(data_sets_.Create(message.name(), message.artifact()));
      });
}

grpc::ServerUnaryReactor* DataHandler::GetDataSet(grpc::CallbackServerContext* context,
                                                  const grpc::ByteBuffer* request,
                                                  grpc::ByteBuffer* response) {
  return unary_.Answer<v1::GetDataSetRequest>(
      {context, request, response}, policy_,
      [this](const v1::GetDataSetRequest& message, const Call&) -> StatusOr<v1::DataSet> {
        return Message(data_sets_.Get(message.name()));
      });
}

grpc::ServerUnaryReactor* DataHandler::ListDataSets(grpc::CallbackServerContext* context,
                                                    const grpc::ByteBuffer* request,
                                                    grpc::ByteBuffer* response) {
  return unary_.Answer<v1::ListDataSetsRequest>(
      {context, request, response}, policy_,
      [this](const v1::ListDataSetsRequest&, const Call&) -> StatusOr<v1::ListDataSetsResponse> {
        v1::ListDataSetsResponse list;
        for (const api::DataSet& set : data_sets_.List()) {
          *list.add_data_sets() = convert::ToProto(set);
        }
        return list;
      });
}

grpc::ServerUnaryReactor* DataHandler::DeleteDataSet(grpc::CallbackServerContext* context,
                                                     const grpc::ByteBuffer* request,
                                                     grpc::ByteBuffer* response) {
  return unary_.Answer<v1::DeleteDataSetRequest>(
      {context, request, response}, policy_,
      [this](const v1::DeleteDataSetRequest& message,
             const Call&) -> StatusOr<google::protobuf::Empty> {
        POISE_RETURN_IF_ERROR(data_sets_.Delete(message.name()));
        return google::protobuf::Empty();
      });
}

}  // namespace poise::server
