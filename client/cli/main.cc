// poise: the command line client. Each sub-command has its own file.
#include <memory>
#include <string_view>
#include <vector>

#include "client/cli/commands.h"
#include "client/cli/help_format.h"
#include "core/base/version.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Human motion in, more and better human motion out.\n\n"
    "Reads BVH, ASF/AMC, AMASS-style npz, CMU exponential-map text and DeepMimic JSON. info, "
    "convert, fk and evaluate work on files alone; augment, correct, predict, push, jobs, train, "
    "models, "
    "data, admin and health ask a Poise server (POISE_SERVER, default 127.0.0.1:50051).";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise info kick.bvh\n"
    "  poise convert kick.amc kick.bvh\n"
    "  poise augment kick.bvh --method ik+timewarp --class kick -n 20 --out kicks\n"
    "  poise correct kick.bvh --method ik -n 20 --effort fast --out corrected\n"
    "  poise predict walk.bvh --horizon 0.4 --out next.bvh\n"
    "  poise jobs list --watch\n\n"
    "`poise COMMAND --help` explains a command. Every command takes --json.\n"
    "Exit codes: 0 ok, 1 internal, 2 usage or bad input, 3 not found, 4 precondition not met,\n"
    "5 no server, 6 cancelled or out of time, 7 a limit was reached, 8 the job failed.";

bool AsksForJson(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--json") return true;
  }
  return false;
}

Status Main(const Console& console, int argc, char** argv) {
  CLI::App app(kDescription, "poise");
  app.formatter(std::make_shared<HelpFormat>());
  // A flag given twice takes the last value, so that scripts can pass their own and then the
  // user's.
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  app.footer(kFooter);
  app.set_version_flag("--version", std::string("poise ") + base::Version());
  std::vector<Command> commands = {AddInfoCommand(app, console),    AddConvertCommand(app, console),
                                   AddFkCommand(app, console),      AddAugmentCommand(app, console),
                                   AddCorrectCommand(app, console), AddPredictCommand(app, console),
                                   AddPushCommand(app, console),    AddHealthCommand(app, console)};
  for (Command& command : AddJobsCommands(app, console)) commands.push_back(std::move(command));
  for (Command& command : AddTrainCommands(app, console)) commands.push_back(std::move(command));
  for (Command& command : AddEvaluateCommands(app, console)) commands.push_back(std::move(command));
  for (Command& command : AddModelsCommands(app, console)) commands.push_back(std::move(command));
  for (Command& command : AddDataCommands(app, console)) commands.push_back(std::move(command));
  for (Command& command : AddAdminCommands(app, console)) commands.push_back(std::move(command));
  POISE_ASSIGN_OR_RETURN(const bool run, ParseCommandLine(app, argc, argv));
  if (!run) return absl::OkStatus();
  for (const Command& command : commands) {
    if (command.app->parsed()) return command.run();
  }
  return absl::OkStatus();
}

}  // namespace
}  // namespace poise::cli

int main(int argc, char** argv) {
  const poise::cli::Console console(poise::cli::AsksForJson(argc, argv));
  return static_cast<int>(console.Finish(poise::cli::Main(console, argc, argv)));
}
