#ifndef POISE_CORE_BASE_STATUS_H_
#define POISE_CORE_BASE_STATUS_H_

#include <optional>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"

/// Errors for programs as well as people: every Status that Poise makes carries, beside its code
/// and message, a stable reason (UPPER_SNAKE_CASE) and, where one is to blame, the offending field
/// of the request or config. The wire layer turns both into google.rpc.ErrorInfo.
namespace poise {

using absl::Status;
using absl::StatusOr;

namespace base {

/// Makes an error. `field` is a dotted path into the caller's input ("sources[0].clip.rotations")
/// or empty when no field is to blame.
Status MakeError(absl::StatusCode code, std::string_view reason, std::string_view field,
                 std::string_view message);

/// Shorthands for the codes that most checks use.
Status InvalidArgument(std::string_view reason, std::string_view field, std::string_view message);
Status NotFound(std::string_view reason, std::string_view field, std::string_view message);
Status FailedPrecondition(std::string_view reason, std::string_view field,
                          std::string_view message);
Status ResourceExhausted(std::string_view reason, std::string_view field, std::string_view message);
Status Internal(std::string_view reason, std::string_view message);

/// The message, as a string of the standard library.
std::string Message(const Status& status);

/// The reason given at construction; for a foreign Status a name made from its code ("NOT_FOUND").
std::string ErrorReason(const Status& status);

/// The offending field, or empty.
std::string ErrorField(const Status& status);

/// The same error with the time after which a retry may succeed; for overload and outages.
Status WithRetryDelay(Status status, absl::Duration delay);
/// That time, if the error carries one.
std::optional<absl::Duration> RetryDelay(const Status& status);

/// Same code, reason and details, with "`context`: " before the message and, when `field_prefix` is
/// not empty, the field moved below it ("sources[2]" + "clip" = "sources[2].clip").
/// An OK status stays OK.
Status Annotate(const Status& status, std::string_view context, std::string_view field_prefix = "");

}  // namespace base
}  // namespace poise

#define POISE_STATUS_CONCAT_INNER(a, b) a##b
#define POISE_STATUS_CONCAT(a, b) POISE_STATUS_CONCAT_INNER(a, b)

/// Returns from the calling function when `expression` is not OK.
#define POISE_RETURN_IF_ERROR(expression)                                                       \
  do {                                                                                          \
    if (::absl::Status poise_status_ = (expression); !poise_status_.ok()) return poise_status_; \
  } while (false)

/// `POISE_ASSIGN_OR_RETURN(auto clip, ReadClip(path));`
#define POISE_ASSIGN_OR_RETURN(lhs, expression) \
  POISE_ASSIGN_OR_RETURN_IMPL(POISE_STATUS_CONCAT(poise_value_, __LINE__), lhs, expression)
#define POISE_ASSIGN_OR_RETURN_IMPL(temporary, lhs, expression) \
  auto temporary = (expression);                                \
  if (!temporary.ok()) return std::move(temporary).status();    \
  lhs = std::move(temporary).value()

#endif  // POISE_CORE_BASE_STATUS_H_
