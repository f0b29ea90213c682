#include "server/log.h"

#include <fmt/format.h>
#include <grpc/support/log.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "absl/time/clock.h"
#include "absl/time/time.h"

namespace poise::server {
namespace {

std::string Now() {
  return absl::FormatTime("%Y-%m-%dT%H:%M:%E6SZ", absl::Now(), absl::UTCTimeZone());
}

level::level_enum LevelOf(gpr_log_severity severity) {
  switch (severity) {
    case GPR_LOG_SEVERITY_ERROR:
      return level::warn;  // mostly about clients that misbehave
    case GPR_LOG_SEVERITY_INFO:
      return level::debug;
    case GPR_LOG_SEVERITY_DEBUG:
      break;
  }
  return level::trace;
}

void LogFromGrpc(gpr_log_func_args* args) {
  Log(LevelOf(args->severity), "grpc",
      {{"file", args->file}, {"line", args->line}, {"message", args->message}});
}

}  // namespace

Status StartLog(const std::string& name) {
  const level::level_enum level = level::from_str(name);
  if (level == level::off && name != "off") {
    return base::InvalidArgument(
        "UNKNOWN_LOG_LEVEL", "log_level",
        fmt::format("'{}' is no log level, expected trace, debug, info, warn, error or off", name));
  }
  auto logger =
      std::make_shared<spdlog::logger>("poised", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern("%v");
  logger->set_level(level);
  logger->flush_on(level::trace);
  spdlog::set_default_logger(std::move(logger));
  gpr_set_log_function(LogFromGrpc);
  return absl::OkStatus();
}

void Log(level::level_enum level, std::string_view event, const base::Json& fields) {
  if (!spdlog::should_log(level)) return;
  const auto level_name = level::to_string_view(level);
  base::Json line = {{"time", Now()},
                     {"level", std::string(level_name.data(), level_name.size())},
                     {"event", event}};
  if (fields.is_object()) line.update(fields);
  // Bytes that are no UTF-8 (from a hostile header, say) must not end the process.
  spdlog::log(level, "{}", line.dump(-1, ' ', false, base::Json::error_handler_t::replace));
}

}  // namespace poise::server
