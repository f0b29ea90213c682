#ifndef POISE_CLIENT_CLI_COMMAND_LINE_H_
#define POISE_CLIENT_CLI_COMMAND_LINE_H_

#include <functional>
#include <string>

#include "CLI/CLI.hpp"
#include "core/base/status.h"

namespace poise::cli {

/// One sub-command of `poise`: its flags, declared on a CLI::App, and what it does.
struct Command {
  CLI::App* app;
  std::function<Status()> run;
};

/// The flag that every command has. Console::json() knows it before the flags are parsed, so that
/// errors in them are JSON too; this declares it for the help and for the parser.
void AddJsonFlag(CLI::App& app);

/// Flags of commands that call a server.
void AddServerFlag(CLI::App& app, std::string& address);
void AddTimeoutFlag(CLI::App& app, double& seconds);

/// Parses the flags. False: help or the version was asked for and has been printed.
/// Errors: kInvalidArgument: UNKNOWN_COMMAND and UNKNOWN_FLAG, naming the nearest known one;
/// BAD_USAGE for everything else, naming the help to read. The field is the flag.
StatusOr<bool> ParseCommandLine(CLI::App& app, int argc, const char* const* argv);

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_COMMAND_LINE_H_
