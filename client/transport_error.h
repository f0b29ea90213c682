#ifndef POISE_CLIENT_TRANSPORT_ERROR_H_
#define POISE_CLIENT_TRANSPORT_ERROR_H_

#include "client/client_options.h"
#include "core/base/status.h"
#include "grpcpp/support/status.h"

namespace poise::client {

/// Address of the server is on this machine.
bool IsLoopback(const std::string& server);

/// What a call ended with, for the caller. An error that Poise made passes unchanged, but for a
/// hint on tokens; one that gRPC made (nobody listens, connection lost, no answer in time) is told
/// in terms of what to do: kUnavailable NO_SERVER (how to start one), BAD_SERVER_ADDRESS,
/// CONNECTION_LOST; kDeadlineExceeded DEADLINE_EXCEEDED; kCancelled CANCELLED; kUnimplemented
/// NOT_A_POISE_SERVER; kResourceExhausted MESSAGE_TOO_LARGE.
Status ExplainCall(const grpc::Status& status, const ClientOptions& options);

}  // namespace poise::client

#endif  // POISE_CLIENT_TRANSPORT_ERROR_H_
