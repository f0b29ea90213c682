#ifndef POISE_SERVER_POISED_OPTIONS_H_
#define POISE_SERVER_POISED_OPTIONS_H_

#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "core/engine/engine.h"
#include "server/server.h"

namespace poise::server {

/// The flags of poised.
struct PoisedOptions {
  ServerConfig server;
  engine::EngineConfig engine{.data_dir = "poise-data"};
  int workers = 0;
  std::string store = "sqlite";
  std::string metrics;
  std::string log_level = "info";
  std::string token_file;
  double lame_duck_s = 5;
  double drain_s = 25;
  double takeover_s = 0;
};

/// The options are complete when `app` has parsed the command line.
void AddFlags(PoisedOptions& options, CLI::App& app);

/// The token from its file or from POISE_TOKEN; empty when there is none.
/// Errors: kFailedPrecondition BAD_TOKEN_FILE.
StatusOr<std::string> ReadToken(const PoisedOptions& options);

}  // namespace poise::server

#endif  // POISE_SERVER_POISED_OPTIONS_H_
