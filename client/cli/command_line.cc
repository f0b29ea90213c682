#include "client/cli/command_line.h"

#include <fmt/format.h>

#include <iostream>

#include "core/base/config_fields.h"

namespace poise::cli {
namespace {

// The innermost sub-command that was typed, or the program itself.
const CLI::App& Chosen(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app : Chosen(*commands.front());
}

// A command that does nothing itself: what follows it should be one of its own.
bool IsGroup(const CLI::App& app) { return !app.get_subcommands(nullptr).empty(); }

std::string FullName(const CLI::App& app) {
  return app.get_parent() == nullptr
             ? app.get_name()
             : fmt::format("{} {}", FullName(*app.get_parent()), app.get_name());
}

std::vector<std::string> CommandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> FlagNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

std::string Suggestion(const std::string& nearest) {
  return nearest.empty() ? "" : fmt::format(" (did you mean '{}'?)", nearest);
}

// "--metod=ik" -> "--metod"
std::string FlagOf(const std::string& argument) { return argument.substr(0, argument.find('=')); }

// The first thing on the command line that no flag or argument takes, if there is one. It is
// reported before what is missing, since a mistyped flag also looks like a missing one.
Status CheckExtras(const CLI::App& app) {
  const CLI::App& chosen = Chosen(app);
  const std::vector<std::string> extras = app.remaining(true);
  if (extras.empty()) return absl::OkStatus();
  const std::string hint = fmt::format("; see '{} --help'", FullName(chosen));
  for (const std::string& extra : extras) {
    if (extra.size() < 2 || extra[0] != '-') continue;
    if (IsGroup(chosen) && extra != extras.front()) break;  // a flag of the unknown command
    const std::string flag = FlagOf(extra);
    return base::InvalidArgument(
        "UNKNOWN_FLAG", flag,
        fmt::format("unknown flag '{}'{}{}", flag,
                    Suggestion(base::NearestName(flag, FlagNames(chosen))), hint));
  }
  if (IsGroup(chosen)) {
    return base::InvalidArgument(
        "UNKNOWN_COMMAND", "",
        fmt::format("unknown command '{}'{}{}", extras.front(),
                    Suggestion(base::NearestName(extras.front(), CommandNames(chosen))), hint));
  }
  return base::InvalidArgument("BAD_USAGE", "",
                               fmt::format("unexpected argument '{}'{}", extras.front(), hint));
}

}  // namespace

void AddJsonFlag(CLI::App& app) {
  const std::string description = "Print JSON for programs: results and errors, an object a line";
  app.add_flag("--json", description);
}

void AddServerFlag(CLI::App& app, std::string& address) {
  app.add_option("--server", address, "HOST:PORT of the server; also from POISE_SERVER")
      ->type_name("ADDRESS")
      ->capture_default_str();
}

void AddTimeoutFlag(CLI::App& app, double& seconds) {
  app.add_option("--timeout", seconds, "Give up after this many seconds")->type_name("SECONDS");
}

StatusOr<bool> ParseCommandLine(CLI::App& app, int argc, const char* const* argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    app.exit(asked, std::cout, std::cerr);
    return false;
  } catch (const CLI::ParseError& error) {
    POISE_RETURN_IF_ERROR(CheckExtras(app));
    return base::InvalidArgument(
        "BAD_USAGE", "", fmt::format("{}; see '{} --help'", error.what(), FullName(Chosen(app))));
  }
  if (const CLI::App& chosen = Chosen(app); IsGroup(chosen)) {
    std::cerr << chosen.help();
    return base::InvalidArgument(
        "BAD_USAGE", "", fmt::format("no command given; see '{} --help'", FullName(chosen)));
  }
  return true;
}

}  // namespace poise::cli
