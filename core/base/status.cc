#include "core/base/status.h"

#include <fmt/format.h>

#include <cstdlib>

#include "absl/strings/cord.h"

namespace poise::base {
namespace {

constexpr char kReasonUrl[] = "poise/reason";
constexpr char kFieldUrl[] = "poise/field";
constexpr char kRetryUrl[] = "poise/retry_ms";

// Debian's Abseil has a string_view of its own.
absl::string_view ToAbsl(std::string_view text) { return {text.data(), text.size()}; }

std::string Payload(const Status& status, const char* url) {
  const auto payload = status.GetPayload(url);
  return payload ? std::string(*payload) : std::string();
}

}  // namespace

Status MakeError(absl::StatusCode code, std::string_view reason, std::string_view field,
                 std::string_view message) {
  Status status(code, ToAbsl(message));
  status.SetPayload(kReasonUrl, absl::Cord(ToAbsl(reason)));
  if (!field.empty()) status.SetPayload(kFieldUrl, absl::Cord(ToAbsl(field)));
  return status;
}

Status InvalidArgument(std::string_view reason, std::string_view field, std::string_view message) {
  return MakeError(absl::StatusCode::kInvalidArgument, reason, field, message);
}

Status NotFound(std::string_view reason, std::string_view field, std::string_view message) {
  return MakeError(absl::StatusCode::kNotFound, reason, field, message);
}

Status FailedPrecondition(std::string_view reason, std::string_view field,
                          std::string_view message) {
  return MakeError(absl::StatusCode::kFailedPrecondition, reason, field, message);
}

Status ResourceExhausted(std::string_view reason, std::string_view field,
                         std::string_view message) {
  return MakeError(absl::StatusCode::kResourceExhausted, reason, field, message);
}

Status Internal(std::string_view reason, std::string_view message) {
  return MakeError(absl::StatusCode::kInternal, reason, "", message);
}

std::string Message(const Status& status) { return std::string(status.message()); }

std::string ErrorReason(const Status& status) {
  std::string reason = Payload(status, kReasonUrl);
  return reason.empty() ? absl::StatusCodeToString(status.code()) : reason;
}

std::string ErrorField(const Status& status) { return Payload(status, kFieldUrl); }

Status WithRetryDelay(Status status, absl::Duration delay) {
  status.SetPayload(kRetryUrl, absl::Cord(std::to_string(absl::ToInt64Milliseconds(delay))));
  return status;
}

std::optional<absl::Duration> RetryDelay(const Status& status) {
  const std::string milliseconds = Payload(status, kRetryUrl);
  if (milliseconds.empty()) return std::nullopt;
  return absl::Milliseconds(std::strtoll(milliseconds.c_str(), nullptr, 10));
}

Status Annotate(const Status& status, std::string_view context, std::string_view field_prefix) {
  if (status.ok()) return status;
  Status result(status.code(), fmt::format("{}: {}", context, Message(status)));
  status.ForEachPayload(
      [&](absl::string_view url, const absl::Cord& payload) { result.SetPayload(url, payload); });
  if (!field_prefix.empty()) {
    const std::string field = ErrorField(status);
    result.SetPayload(kFieldUrl,
                      absl::Cord(field.empty() ? std::string(field_prefix)
                                               : fmt::format("{}.{}", field_prefix, field)));
  }
  return result;
}

}  // namespace poise::base
