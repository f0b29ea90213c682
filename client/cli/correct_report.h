#ifndef POISE_CLIENT_CLI_CORRECT_REPORT_H_
#define POISE_CLIENT_CLI_CORRECT_REPORT_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/api/correction_report.h"
#include "core/api/job.h"
#include "core/base/json.h"

namespace poise::cli {

/// A clip's correction, as it ended.
struct CorrectedClip {
  std::string name;
  api::Job job;
  std::optional<api::CorrectedClipReport> report;  ///< of a job that SUCCEEDED
};

/// {"clip" "job" "state" "wall_s" "error" and the report's fields}; files with their folder. What
/// is not there is null.
base::Json CorrectedClipJson(const CorrectedClip& clip, const std::filesystem::path& folder);

/// Two tables with, for each clip, its variants before and after (mean), the worst of them and the
/// zero policy: how plausible they look, and how they were imitated, with the outer force and
/// torque that it took beside every reward. Below what was not completed, and what ended a job
/// early.
std::string CorrectionText(const std::vector<CorrectedClip>& clips);

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_CORRECT_REPORT_H_
