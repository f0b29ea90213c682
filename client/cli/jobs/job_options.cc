#include "client/cli/jobs/job_options.h"

#include <fmt/format.h>

#include "absl/time/clock.h"
#include "proto/convert/job_convert.h"

namespace poise::cli {

void AddConnectionFlags(CLI::App& command, client::ClientOptions& options) {
  AddServerFlag(command, options.server);
  command.add_option("--tenant", options.tenant, "Whose jobs; also from POISE_TENANT")
      ->type_name("NAME");
  AddJsonFlag(command);
}

StatusOr<std::string> ParseJobName(const std::string& text) {
  return convert::JobId(text.starts_with("jobs/") ? text : convert::JobName(text));
}

StatusOr<std::vector<std::string>> ParseJobNames(const std::vector<std::string>& texts) {
  std::vector<std::string> ids;
  for (const std::string& text : texts) {
    POISE_ASSIGN_OR_RETURN(std::string id, ParseJobName(text));
    ids.push_back(std::move(id));
  }
  return ids;
}

StatusOr<std::map<std::string, std::string>> ParsePairs(const std::vector<std::string>& pairs,
                                                        const std::string& flag) {
  std::map<std::string, std::string> parsed;
  for (const std::string& pair : pairs) {
    const size_t equals = pair.find('=');
    if (equals == std::string::npos || equals == 0) {
      return base::InvalidArgument("BAD_USAGE", flag,
                                   fmt::format("--{} has '{}', expected KEY=VALUE", flag, pair));
    }
    parsed[pair.substr(0, equals)] = pair.substr(equals + 1);
  }
  return parsed;
}

absl::Time DeadlineAfter(double seconds) {
  return seconds > 0 ? absl::Now() + absl::Seconds(seconds) : absl::InfiniteFuture();
}

}  // namespace poise::cli
