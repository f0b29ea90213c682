#include "proto/convert/status_convert.h"

#include <optional>
#include <string>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "proto/convert/utf8.h"

namespace poise::convert {
namespace {

// gRPC refuses trailing metadata above 8 KiB; the message travels three times, once with every
// unusual byte as three characters.
constexpr size_t kMaxMessageBytes = 1000;
constexpr size_t kMaxFieldBytes = 200;
constexpr char kFieldKey[] = "field";

std::string Shorten(const std::string& text, size_t max_bytes) {
  if (text.size() <= max_bytes) return ValidUtf8(text);
  return ValidUtf8(text.substr(0, max_bytes)) + "...";
}

void AddRetryInfo(absl::Duration delay, google::rpc::Status& details) {
  google::rpc::RetryInfo retry;
  const int64_t milliseconds = absl::ToInt64Milliseconds(delay);
  retry.mutable_retry_delay()->set_seconds(milliseconds / 1000);
  retry.mutable_retry_delay()->set_nanos(static_cast<int32_t>(milliseconds % 1000 * 1'000'000));
  details.add_details()->PackFrom(retry);
}

}  // namespace

grpc::Status ToGrpc(const Status& status) {
  if (status.ok()) return grpc::Status::OK;
  const std::string message = Shorten(base::Message(status), kMaxMessageBytes);
  const std::string field = Shorten(base::ErrorField(status), kMaxFieldBytes);
  google::rpc::Status details;
  details.set_code(static_cast<int>(status.code()));
  details.set_message(message);

  google::rpc::ErrorInfo info;
  info.set_reason(base::ErrorReason(status));
  info.set_domain(kErrorDomain);
  if (!field.empty()) (*info.mutable_metadata())[kFieldKey] = field;
  details.add_details()->PackFrom(info);
  if (!field.empty()) {
    google::rpc::BadRequest request;
    google::rpc::BadRequest::FieldViolation* violation = request.add_field_violations();
    violation->set_field(field);
    violation->set_description(message);
    details.add_details()->PackFrom(request);
  }
  if (const std::optional<absl::Duration> delay = base::RetryDelay(status)) {
    AddRetryInfo(*delay, details);
  }
  return grpc::Status(static_cast<grpc::StatusCode>(status.code()), message,
                      details.SerializeAsString());
}

Status FromGrpc(const grpc::Status& status) {
  if (status.ok()) return absl::OkStatus();
  const auto code = static_cast<absl::StatusCode>(status.error_code());
  Status result(code, status.error_message());
  google::rpc::Status details;
  if (!details.ParseFromString(status.error_details())) return result;
  std::optional<absl::Duration> retry;
  for (const google::protobuf::Any& detail : details.details()) {
    google::rpc::ErrorInfo info;
    google::rpc::RetryInfo retry_info;
    if (detail.UnpackTo(&info) && info.domain() == kErrorDomain) {
      const auto field = info.metadata().find(kFieldKey);
      result =
          base::MakeError(code, info.reason(), field == info.metadata().end() ? "" : field->second,
                          status.error_message());
    } else if (detail.UnpackTo(&retry_info)) {
      retry = absl::Seconds(retry_info.retry_delay().seconds()) +
              absl::Nanoseconds(retry_info.retry_delay().nanos());
    }
  }
  return retry ? base::WithRetryDelay(result, *retry) : result;
}

}  // namespace poise::convert
