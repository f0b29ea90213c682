#ifndef POISE_TESTS_SUPPORT_RAW_CALL_H_
#define POISE_TESTS_SUPPORT_RAW_CALL_H_

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include <memory>
#include <string>

#include "google/rpc/error_details.pb.h"

namespace poise::testing {

/// Calls a method with one message of any bytes and reads at most `max_responses` answers; when
/// there are more, cancels the call and returns OK.
grpc::Status RawCall(const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
                     const std::string& bytes, int max_responses = 1);

/// The ErrorInfo in an error's details; empty when it has none.
google::rpc::ErrorInfo ErrorInfoOf(const grpc::Status& status);

/// What grpc.health.v1.Health says of a service: "SERVING", "NOT_SERVING", or the error.
std::string HealthOf(const std::shared_ptr<grpc::Channel>& channel, const std::string& service);

}  // namespace poise::testing

#endif  // POISE_TESTS_SUPPORT_RAW_CALL_H_
