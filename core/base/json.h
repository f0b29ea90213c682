#ifndef POISE_CORE_BASE_JSON_H_
#define POISE_CORE_BASE_JSON_H_

#include <cstdint>
#include <string_view>
#include <utility>

#include "core/base/status.h"
#include "nlohmann/json.hpp"

namespace poise::base {

/// Keys keep the order in which they were written: output is for people too.
using Json = nlohmann::ordered_json;

/// Errors: kInvalidArgument (MALFORMED_JSON) with the byte offset; `what` names the text in it.
StatusOr<Json> ParseJson(std::string_view text, std::string_view what);

/// The whole number in `json`. Json::get would cast what does not fit, which is undefined.
/// Throws Json::type_error when it is no whole number or does not fit.
template <typename Integer>
Integer IntegerFrom(const Json& json) {
  if (json.is_number_unsigned()) {
    const auto value = json.get<uint64_t>();
    if (std::in_range<Integer>(value)) return static_cast<Integer>(value);
  } else if (json.is_number_integer()) {
    const auto value = json.get<int64_t>();
    if (std::in_range<Integer>(value)) return static_cast<Integer>(value);
  }
  throw Json::type_error::create(302, "expected a whole number that fits", &json);
}

}  // namespace poise::base

#endif  // POISE_CORE_BASE_JSON_H_
