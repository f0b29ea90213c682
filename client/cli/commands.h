#ifndef POISE_CLIENT_CLI_COMMANDS_H_
#define POISE_CLIENT_CLI_COMMANDS_H_

#include <vector>

#include "client/cli/command_line.h"
#include "client/cli/console.h"

/// The sub-commands, each in the file of its name. `console` outlives them.
namespace poise::cli {

/// What is in a motion file (info_command.cc).
Command AddInfoCommand(CLI::App& app, const Console& console);
/// Any format to BVH, with edits on the way (convert_command.cc).
Command AddConvertCommand(CLI::App& app, const Console& console);
/// Where the joints are (fk_command.cc).
Command AddFkCommand(CLI::App& app, const Console& console);
/// Variants of clips, made by a server (augment_command.cc).
Command AddAugmentCommand(CLI::App& app, const Console& console);
/// What comes next in a motion (predict_command.cc).
Command AddPredictCommand(CLI::App& app, const Console& console);
/// Variants that a simulated body has imitated (correct_command.cc).
Command AddCorrectCommand(CLI::App& app, const Console& console);
/// What people do after a push, forecast by a server (push_command.cc).
Command AddPushCommand(CLI::App& app, const Console& console);
/// Whether a server takes calls (health_command.cc).
Command AddHealthCommand(CLI::App& app, const Console& console);
/// Long work on a server (jobs_command.cc, jobs/).
std::vector<Command> AddJobsCommands(CLI::App& app, const Console& console);
/// Trained networks on a server (models_command.cc).
std::vector<Command> AddModelsCommands(CLI::App& app, const Console& console);
/// Training data on a server (data_command.cc).
std::vector<Command> AddDataCommands(CLI::App& app, const Console& console);
/// Trains networks on a server (train_command.cc).
std::vector<Command> AddTrainCommands(CLI::App& app, const Console& console);
/// How good what was made is (evaluate_command.cc).
std::vector<Command> AddEvaluateCommands(CLI::App& app, const Console& console);
/// For operators (admin_command.cc).
std::vector<Command> AddAdminCommands(CLI::App& app, const Console& console);

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_COMMANDS_H_
