#include "client/client_options.h"

#include <cstdlib>

namespace poise::client {
namespace {

void TakeFromEnvironment(const char* name, std::string& value) {
  const char* text = std::getenv(name);
  if (text != nullptr && *text != '\0') value = text;
}

}  // namespace

ClientOptions ClientOptions::FromEnvironment() {
  ClientOptions options;
  TakeFromEnvironment("POISE_SERVER", options.server);
  TakeFromEnvironment("POISE_TOKEN", options.token);
  TakeFromEnvironment("POISE_TENANT", options.tenant);
  return options;
}

}  // namespace poise::client
