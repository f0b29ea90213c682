#include "server/worker/child_environment.h"

#include <unistd.h>

#include <string_view>

namespace poise::worker {

std::vector<std::string> ChildEnvironment() {
  constexpr std::string_view kThreads = "OMP_NUM_THREADS=";
  std::vector<std::string> variables;
  bool has_threads = false;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text = *variable;
    if (text.starts_with("POISE_TOKEN=")) continue;
    has_threads = has_threads || text.starts_with(kThreads);
    variables.emplace_back(text);
  }
  if (!has_threads) variables.push_back(std::string(kThreads) + "1");
  return variables;
}

}  // namespace poise::worker
