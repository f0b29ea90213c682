#ifndef POISE_CLIENT_CLI_EXIT_CODE_H_
#define POISE_CLIENT_CLI_EXIT_CODE_H_

#include "core/base/status.h"

namespace poise::cli {

/// What the program's exit code says. The numbers are fixed: scripts rely on them.
enum class ExitCode {
  kOk = 0,
  kInternal = 1,
  kInvalidArgument = 2,  ///< wrong usage too
  kNotFound = 3,
  kFailedPrecondition = 4,  ///< also: not allowed without the right token
  kUnavailable = 5,
  kStopped = 6,  ///< cancelled, or out of time
  kResourceExhausted = 7,
  kJobFailed = 8,
};

/// Reasons of the errors with which a command ends that waited for a job: it did its own part, and
/// the job is told by its own line.
inline constexpr char kJobFailedReason[] = "JOB_FAILED";
inline constexpr char kJobCancelledReason[] = "JOB_CANCELLED";
bool IsJobOutcome(const Status& status);

ExitCode ExitCodeOf(const Status& status);

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_EXIT_CODE_H_
