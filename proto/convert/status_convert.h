#ifndef POISE_PROTO_CONVERT_STATUS_CONVERT_H_
#define POISE_PROTO_CONVERT_STATUS_CONVERT_H_

#include "core/base/status.h"
#include "grpcpp/support/status.h"

/// Errors between memory and the wire, with their details in google.rpc.Status (AIP-193).
namespace poise::convert {

inline constexpr char kErrorDomain[] = "poise.dev";

/// An error gets ErrorInfo {reason, domain "poise.dev", metadata {"field": ...}}; with a known
/// field also BadRequest.FieldViolation, and with a retry time RetryInfo. Long messages are cut:
/// trailing metadata has a size limit, beyond which the whole error would be lost.
grpc::Status ToGrpc(const Status& status);

/// The inverse. A status without our details (from gRPC itself: no connection, deadline) gets the
/// name of its code as the reason.
Status FromGrpc(const grpc::Status& status);

}  // namespace poise::convert

#endif  // POISE_PROTO_CONVERT_STATUS_CONVERT_H_
