#ifndef POISE_CLIENT_CLI_JOBS_JOB_TEXT_H_
#define POISE_CLIENT_CLI_JOBS_JOB_TEXT_H_

#include <string>
#include <vector>

#include "absl/time/time.h"
#include "core/api/job.h"

/// Jobs as people read them.
namespace poise::cli {

/// "[#####.....]  50/100  0:12 left", without a total "step 50"; empty before the first step.
std::string ProgressText(const base::Progress& progress);

/// "3 s", "12 min", "5 h", "9 d"
std::string DurationText(absl::Duration duration);

/// One line: "jobs/<id>  RUNNING  [#####.....]  50/100  attempt 2".
std::string JobLine(const api::Job& job);

/// A table, one row a job, with ages as of `now`.
std::string JobTable(const std::vector<api::Job>& jobs, absl::Time now);

/// Everything about one job, over several lines.
std::string JobDetails(const api::Job& job);

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_JOBS_JOB_TEXT_H_
