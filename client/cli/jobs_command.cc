#include "client/cli/commands.h"
#include "client/cli/jobs/commands.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Long work on a Poise server: create, list, get, watch, cancel, result, delete, retry.\n\n"
    "A job is durable from the moment in which create prints its name. It runs in a process of its "
    "own, and runs again from its last checkpoint when that process, its worker or the server is "
    "lost. It ends SUCCEEDED, FAILED or CANCELLED, and never changes after that.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise jobs create selftest --param steps=100\n"
    "  poise jobs list --watch\n"
    "  poise jobs result jobs/019abc --out files\n\n"
    "`poise jobs COMMAND --help` explains a command.";

}  // namespace

std::vector<Command> AddJobsCommands(CLI::App& app, const Console& console) {
  CLI::App* jobs = app.add_subcommand("jobs", kDescription);
  jobs->footer(kFooter);
  return {AddJobsCreateCommand(*jobs, console), AddJobsListCommand(*jobs, console),
          AddJobsGetCommand(*jobs, console),    AddJobsWatchCommand(*jobs, console),
          AddJobsCancelCommand(*jobs, console), AddJobsResultCommand(*jobs, console),
          AddJobsDeleteCommand(*jobs, console), AddJobsRetryCommand(*jobs, console)};
}

}  // namespace poise::cli
