#include "client/cli/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace poise::cli {

bool Console::HasTerminal() {
  const char* term = std::getenv("TERM");
  return isatty(STDERR_FILENO) != 0 && term != nullptr && std::string_view(term) != "dumb";
}

void Console::Print(std::string_view line) const {
  fmt::print(stdout, "{}\n", line);
  std::fflush(stdout);
}

void Console::PrintJson(const base::Json& object) const {
  // Joint names may hold bytes that are not UTF-8; a reader of JSON gets U+FFFD for them.
  Print(object.dump(-1, ' ', false, base::Json::error_handler_t::replace));
}

void Console::Note(std::string_view line) const {
  if (!json_) fmt::print(stderr, "{}\n", line);
}

ExitCode Console::Finish(const Status& status) const {
  if (status.ok()) return ExitCode::kOk;
  if (json_ && IsJobOutcome(status)) {
    // The job's own line has its error.
  } else if (json_) {
    PrintJson({{"error",
                {{"code", absl::StatusCodeToString(status.code())},
                 {"reason", base::ErrorReason(status)},
                 {"message", base::Message(status)},
                 {"field", base::ErrorField(status)}}}});
  } else {
    fmt::print(stderr, "poise: {}\n", base::Message(status));
  }
  return ExitCodeOf(status);
}

}  // namespace poise::cli
