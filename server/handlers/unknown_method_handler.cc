#include "server/handlers/unknown_method_handler.h"

#include <fmt/format.h>

#include "core/base/version.h"
#include "server/handlers/refusal.h"

namespace poise::server {

grpc::ServerGenericBidiReactor* UnknownMethodHandler::CreateReactor(
    grpc::GenericCallbackServerContext* context) {
  return new Refusal<grpc::ServerGenericBidiReactor>(base::MakeError(
      absl::StatusCode::kUnimplemented, "UNKNOWN_METHOD", "",
      fmt::format("poised {} has no method {}", base::Version(), context->method())));
}

}  // namespace poise::server
