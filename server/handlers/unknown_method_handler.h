#ifndef POISE_SERVER_HANDLERS_UNKNOWN_METHOD_HANDLER_H_
#define POISE_SERVER_HANDLERS_UNKNOWN_METHOD_HANDLER_H_

#include <grpcpp/generic/async_generic_service.h>

namespace poise::server {

/// Answers calls of methods that this server does not have: UNIMPLEMENTED, reason UNKNOWN_METHOD.
class UnknownMethodHandler : public grpc::CallbackGenericService {
 public:
  grpc::ServerGenericBidiReactor* CreateReactor(
      grpc::GenericCallbackServerContext* context) override;
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_UNKNOWN_METHOD_HANDLER_H_
