#ifndef POISE_CLIENT_CLI_JOBS_JOB_JSON_H_
#define POISE_CLIENT_CLI_JOBS_JOB_JSON_H_

#include <string>

#include "core/api/job.h"
#include "core/base/json.h"

namespace poise::cli {

/// A job as `poise jobs` prints it for programs: everything that the server tells. What is not
/// known, or not yet, is null.
base::Json JobJson(const api::Job& job);

/// One entry of a job's event stream; exactly one of "state", "progress" and "checkpoint" is there.
base::Json EventJson(const std::string& id, const api::JobEvent& event);

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_JOBS_JOB_JSON_H_
