#include "server/interceptors/request_log.h"

#include <grpcpp/server_context.h>

#include <chrono>
#include <string>

#include "absl/status/status.h"
#include "server/log.h"

namespace poise::server {
namespace {

using grpc::experimental::InterceptionHookPoints;
using Clock = std::chrono::steady_clock;

std::string CodeName(grpc::StatusCode code) {
  return absl::StatusCodeToString(static_cast<absl::StatusCode>(code));
}

// A caller may invent method names; a counter for each would be a way to fill the memory.
std::string CounterLabel(const std::string& method) {
  const bool known = method.starts_with("/poise.") || method.starts_with("/grpc.") ||
                     method.starts_with("/google.longrunning.");
  return known ? method : "unknown";
}

class RequestLog : public grpc::experimental::Interceptor {
 public:
  RequestLog(grpc::experimental::ServerRpcInfo* info, base::Telemetry& telemetry)
      : method_(info->method()), peer_(info->server_context()->peer()), telemetry_(telemetry) {}

  // gRPC destroys the interceptor when the call is over.
  ~RequestLog() override {
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    const base::Labels labels = {{"method", CounterLabel(method_)}, {"code", code_}};
    telemetry_.counter("poise_requests_total", "Calls that ended", labels).Increment();
    telemetry_
        .histogram("poise_request_seconds", "Time from a call's start to its end",
                   {{"method", CounterLabel(method_)}})
        .Observe(seconds);
    Log(LogLevel(), "request",
        {{"method", method_},
         {"code", code_},
         {"message", message_},
         {"request_id", request_id_},
         {"peer", peer_},
         {"duration_ms", static_cast<int64_t>(seconds * 1e6) / 1e3}});
  }

  void Intercept(grpc::experimental::InterceptorBatchMethods* methods) override {
    if (methods->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_INITIAL_METADATA)) {
      const auto* metadata = methods->GetSendInitialMetadata();
      const auto id = metadata->find("x-request-id");
      if (id != metadata->end()) request_id_ = id->second;
    }
    if (methods->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_STATUS)) {
      const grpc::Status status = methods->GetSendStatus();
      code_ = CodeName(status.error_code());
      message_ = status.error_message();
    }
    methods->Proceed();
  }

 private:
  // Workers are heard of all day; only what went wrong is news.
  level::level_enum LogLevel() const {
    const bool routine = code_ == "OK" && method_.starts_with("/poise.v1.WorkerService/");
    return routine ? level::debug : level::info;
  }

  const std::string method_;
  const std::string peer_;
  base::Telemetry& telemetry_;
  const Clock::time_point start_ = Clock::now();
  std::string code_ = "UNKNOWN";
  std::string message_;
  std::string request_id_;
};

}  // namespace

grpc::experimental::Interceptor* RequestLogFactory::CreateServerInterceptor(
    grpc::experimental::ServerRpcInfo* info) {
  return new RequestLog(info, telemetry_);
}

}  // namespace poise::server
