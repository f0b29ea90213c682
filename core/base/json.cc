#include "core/base/json.h"

#include <fmt/format.h>

namespace poise::base {

StatusOr<Json> ParseJson(std::string_view text, std::string_view what) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    return InvalidArgument("MALFORMED_JSON", "",
                           fmt::format("{}: not JSON at byte {}", what, error.byte));
  } catch (const Json::exception&) {
    return InvalidArgument("MALFORMED_JSON", "",
                           fmt::format("{}: JSON with a number out of range", what));
  }
}

}  // namespace poise::base
