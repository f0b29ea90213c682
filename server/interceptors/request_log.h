#ifndef POISE_SERVER_INTERCEPTORS_REQUEST_LOG_H_
#define POISE_SERVER_INTERCEPTORS_REQUEST_LOG_H_

#include <grpcpp/support/server_interceptor.h>

#include "core/base/telemetry.h"

namespace poise::server {

/// One log line and two measurements per call, of every service: method, code, time.
class RequestLogFactory : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  explicit RequestLogFactory(base::Telemetry& telemetry) : telemetry_(telemetry) {}

  grpc::experimental::Interceptor* CreateServerInterceptor(
      grpc::experimental::ServerRpcInfo* info) override;

 private:
  base::Telemetry& telemetry_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_INTERCEPTORS_REQUEST_LOG_H_
