#include <fmt/format.h>

#include <memory>

#include "client/cli/commands.h"
#include "client/client.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Ask a Poise server whether it takes calls.\n\n"
    "For a container's health check, or a script that waits for it. Exit code 0: it does; 5: it is "
    "not there, or about to stop.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise health\n"
    "  until poise health; do sleep 1; done\n"
    "  poise health --server motion.example.org:50051 --json";

Status RunHealth(const client::ClientOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options));
  POISE_ASSIGN_OR_RETURN(const client::ServerHealth health, client->Health());
  if (health != client::ServerHealth::kServing) {
    return base::MakeError(absl::StatusCode::kUnavailable, "NOT_SERVING", "server",
                           fmt::format("{} answers but takes no calls now", options.server));
  }
  if (console.json()) {
    console.PrintJson({{"server", options.server}, {"status", "SERVING"}});
  } else {
    console.Print(fmt::format("{} is serving", options.server));
  }
  return absl::OkStatus();
}

}  // namespace

Command AddHealthCommand(CLI::App& app, const Console& console) {
  auto options = std::make_shared<client::ClientOptions>(client::ClientOptions::FromEnvironment());
  options->timeout = options->connect_timeout;
  CLI::App* command = app.add_subcommand("health", kDescription);
  command->footer(kFooter);
  AddServerFlag(*command, options->server);
  AddJsonFlag(*command);
  return {command, [options, &console] { return RunHealth(*options, console); }};
}

}  // namespace poise::cli
