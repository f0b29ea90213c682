#ifndef POISE_CLIENT_CLI_JOBS_COMMANDS_H_
#define POISE_CLIENT_CLI_JOBS_COMMANDS_H_

#include "client/cli/command_line.h"
#include "client/cli/console.h"

/// The commands below `poise jobs`, each in the file of its name.
namespace poise::cli {

Command AddJobsCreateCommand(CLI::App& jobs, const Console& console);
Command AddJobsListCommand(CLI::App& jobs, const Console& console);
Command AddJobsGetCommand(CLI::App& jobs, const Console& console);
Command AddJobsWatchCommand(CLI::App& jobs, const Console& console);
Command AddJobsCancelCommand(CLI::App& jobs, const Console& console);
Command AddJobsResultCommand(CLI::App& jobs, const Console& console);
Command AddJobsDeleteCommand(CLI::App& jobs, const Console& console);
Command AddJobsRetryCommand(CLI::App& jobs, const Console& console);

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_JOBS_COMMANDS_H_
