#include "server/handlers/admin_handler.h"

#include <filesystem>
#include <system_error>

#include "proto/convert/utf8.h"

namespace poise::server {
namespace {

v1::DiagnoseResponse::Finding::Severity ToProto(jobs::Finding::Severity severity) {
  switch (severity) {
    case jobs::Finding::Severity::kOk:
      return v1::DiagnoseResponse::Finding::OK;
    case jobs::Finding::Severity::kWarning:
      return v1::DiagnoseResponse::Finding::WARNING;
    case jobs::Finding::Severity::kFault:
      return v1::DiagnoseResponse::Finding::FAULT;
  }
  return v1::DiagnoseResponse::Finding::SEVERITY_UNSPECIFIED;
}

}  // namespace

AdminHandler::AdminHandler(engine::JobManager& jobs, Admission& admission,
                           const MethodPolicy& policy)
    : jobs_(jobs), policy_(policy), unary_(admission, pool_) {}

grpc::ServerUnaryReactor* AdminHandler::Diagnose(grpc::CallbackServerContext* context,
                                                 const grpc::ByteBuffer* request,
                                                 grpc::ByteBuffer* response) {
  return unary_.Answer<v1::DiagnoseRequest>(
      {context, request, response}, policy_,
      [this](const v1::DiagnoseRequest&, const Call& call) -> StatusOr<v1::DiagnoseResponse> {
        POISE_ASSIGN_OR_RETURN(const std::vector<jobs::Finding> findings,
                               jobs_.Diagnose(call.run()));
        v1::DiagnoseResponse answer;
        for (const jobs::Finding& finding : findings) {
          v1::DiagnoseResponse::Finding* message = answer.add_findings();
          message->set_severity(ToProto(finding.severity));
          message->set_check(finding.check);
          message->set_message(convert::ValidUtf8(finding.message));
        }
        return answer;
      });
}

grpc::ServerUnaryReactor* AdminHandler::BackUpStore(grpc::CallbackServerContext* context,
                                                    const grpc::ByteBuffer* request,
                                                    grpc::ByteBuffer* response) {
  return unary_.Answer<v1::BackUpStoreRequest>(
      {context, request, response}, policy_,
      [this](const v1::BackUpStoreRequest& message,
             const Call&) -> StatusOr<v1::BackUpStoreResponse> {
        POISE_ASSIGN_OR_RETURN(const std::filesystem::path path, jobs_.BackUp(message.path()));
        std::error_code ignored;
        v1::BackUpStoreResponse answer;
        answer.set_path(convert::ValidUtf8(path.string()));
        answer.set_size_bytes(static_cast<int64_t>(std::filesystem::file_size(path, ignored)));
        return answer;
      });
}

}  // namespace poise::server
