#ifndef POISE_SERVER_LOG_H_
#define POISE_SERVER_LOG_H_

#include <spdlog/common.h>

#include <string_view>

#include "core/base/json.h"
#include "core/base/status.h"

/// Structured logs: one JSON object a line on stderr, {"time", "level", "event", ...fields}.
/// gRPC's own messages come as event "grpc".
namespace poise::server {

namespace level = spdlog::level;

/// `name` is trace, debug, info, warn, error or off. Errors: kInvalidArgument UNKNOWN_LOG_LEVEL.
Status StartLog(const std::string& name);

/// Threads: any. Does nothing below the level that was asked for.
void Log(level::level_enum level, std::string_view event, const base::Json& fields = {});

}  // namespace poise::server

#endif  // POISE_SERVER_LOG_H_
