#ifndef POISE_CLIENT_CLI_EXIT_CODE_H_
#define POISE_CLIENT_CLI_EXIT_CODE_H_

#include "core/base/exit_code.h"
#include "core/base/status.h"

namespace poise::cli {

using base::ExitCode;

/// Reasons of the errors with which a command ends that waited for a job: it did its own part, and
/// the job is told by its own line.
inline constexpr char kJobFailedReason[] = "JOB_FAILED";
inline constexpr char kJobCancelledReason[] = "JOB_CANCELLED";
bool IsJobOutcome(const Status& status);

/// base::ExitCodeOf, and kJobFailed.
ExitCode ExitCodeOf(const Status& status);

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_EXIT_CODE_H_
