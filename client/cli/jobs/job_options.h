#ifndef POISE_CLIENT_CLI_JOBS_JOB_OPTIONS_H_
#define POISE_CLIENT_CLI_JOBS_JOB_OPTIONS_H_

#include <map>
#include <string>
#include <vector>

#include "client/cli/command_line.h"
#include "client/client_options.h"
#include "core/base/status.h"

/// What the commands about jobs have in common.
namespace poise::cli {

/// --server, --tenant and --json.
void AddConnectionFlags(CLI::App& command, client::ClientOptions& options);

/// "jobs/<id>" or "<id>". Errors: kInvalidArgument BAD_JOB_NAME.
StatusOr<std::string> ParseJobName(const std::string& text);
StatusOr<std::vector<std::string>> ParseJobNames(const std::vector<std::string>& texts);

/// KEY=VALUE each. Errors: kInvalidArgument BAD_USAGE with the flag.
StatusOr<std::map<std::string, std::string>> ParsePairs(const std::vector<std::string>& pairs,
                                                        const std::string& flag);

/// From now; never for 0.
absl::Time DeadlineAfter(double seconds);

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_JOBS_JOB_OPTIONS_H_
