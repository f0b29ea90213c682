#ifndef POISE_CORE_BASE_JSON_H_
#define POISE_CORE_BASE_JSON_H_

#include <string_view>

#include "core/base/status.h"
#include "nlohmann/json.hpp"

namespace poise::base {

/// Keys keep the order in which they were written: output is for people too.
using Json = nlohmann::ordered_json;

/// Errors: kInvalidArgument (MALFORMED_JSON) with the byte offset; `what` names the text in it.
StatusOr<Json> ParseJson(std::string_view text, std::string_view what);

}  // namespace poise::base

#endif  // POISE_CORE_BASE_JSON_H_
