#include "client/transport_error.h"

#include <fmt/format.h>

#include "proto/convert/status_convert.h"

namespace poise::client {
namespace {

bool Contains(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

Status ExplainUnavailable(const std::string& message, const std::string& server) {
  constexpr auto kCode = absl::StatusCode::kUnavailable;
  if (Contains(message, "DNS resolution failed") || Contains(message, "name resolution")) {
    return base::MakeError(
        kCode, "BAD_SERVER_ADDRESS", "server",
        fmt::format("server address '{}' cannot be resolved; expected HOST:PORT (--server or "
                    "POISE_SERVER)",
                    server));
  }
  if (Contains(message, "failed to connect") || Contains(message, "onnection refused") ||
      Contains(message, "connections to all backends failing")) {
    const std::string start =
        IsLoopback(server)
            ? fmt::format("start one: poised --listen {} --data-dir ~/.poise", server)
            : "check the address (--server or POISE_SERVER) and that poised runs there";
    return base::MakeError(kCode, "NO_SERVER", "server",
                           fmt::format("no server answers at {}; {}", server, start));
  }
  return base::MakeError(
      kCode, "CONNECTION_LOST", "server",
      fmt::format("the connection to {} was lost: {}; the server stopped, or expects TLS", server,
                  message));
}

}  // namespace

bool IsLoopback(const std::string& server) {
  return server.starts_with("127.") || server.starts_with("localhost:") ||
         server.starts_with("[::1]:");
}

Status ExplainCall(const grpc::Status& status, const ClientOptions& options) {
  if (status.ok()) return absl::OkStatus();
  const bool made_by_poise = !status.error_details().empty();
  if (status.error_code() == grpc::StatusCode::UNAUTHENTICATED && options.token.empty()) {
    return base::Annotate(convert::FromGrpc(status), "no token given (set POISE_TOKEN)");
  }
  if (made_by_poise) return convert::FromGrpc(status);
  const std::string& message = status.error_message();
  switch (status.error_code()) {
    case grpc::StatusCode::UNAVAILABLE:
      return ExplainUnavailable(message, options.server);
    case grpc::StatusCode::DEADLINE_EXCEEDED:
      return base::MakeError(
          absl::StatusCode::kDeadlineExceeded, "DEADLINE_EXCEEDED", "",
          fmt::format("the server at {} did not finish in time", options.server));
    case grpc::StatusCode::CANCELLED:
      return base::MakeError(absl::StatusCode::kCancelled, "CANCELLED", "", "cancelled");
    case grpc::StatusCode::UNIMPLEMENTED:
      return base::MakeError(
          absl::StatusCode::kUnimplemented, "NOT_A_POISE_SERVER", "server",
          fmt::format("the server at {} does not offer this call: another program, or another "
                      "version of poised",
                      options.server));
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
      return base::ResourceExhausted("MESSAGE_TOO_LARGE", "", message);
    default:
      return convert::FromGrpc(status);
  }
}

}  // namespace poise::client
