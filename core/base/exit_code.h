#ifndef POISE_CORE_BASE_EXIT_CODE_H_
#define POISE_CORE_BASE_EXIT_CODE_H_

#include "core/base/status.h"

namespace poise::base {

/// What the exit code of every Poise program says. The numbers are fixed: scripts rely on them.
enum class ExitCode {
  kOk = 0,
  kInternal = 1,
  kInvalidArgument = 2,  ///< wrong usage too
  kNotFound = 3,
  kFailedPrecondition = 4,  ///< also: not allowed without the right token
  kUnavailable = 5,
  kStopped = 6,  ///< cancelled, or out of time
  kResourceExhausted = 7,
  kJobFailed = 8,  ///< of `poise`, when it waited for a job that failed
};

ExitCode ExitCodeOf(const Status& status);

}  // namespace poise::base

#endif  // POISE_CORE_BASE_EXIT_CODE_H_
