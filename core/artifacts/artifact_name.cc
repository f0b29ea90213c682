#include "core/artifacts/artifact_name.h"

#include <fmt/format.h>

#include <algorithm>

namespace poise::artifacts {
namespace {

constexpr std::string_view kPrefix = "artifacts/";
constexpr size_t kDigits = 64;
constexpr size_t kShownLength = 100;

}  // namespace

std::string ArtifactName(std::string_view sha256) { return fmt::format("{}{}", kPrefix, sha256); }

bool IsSha256(std::string_view text) {
  return text.size() == kDigits && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

StatusOr<std::string> DigestOf(std::string_view artifact_name) {
  if (artifact_name.starts_with(kPrefix)) {
    const std::string_view digest = artifact_name.substr(kPrefix.size());
    if (IsSha256(digest)) return std::string(digest);
  }
  return base::InvalidArgument(
      "BAD_ARTIFACT_NAME", "name",
      fmt::format("'{}' is no artifact's name, expected artifacts/ and 64 lower-case hex digits",
                  artifact_name.substr(0, kShownLength)));
}

}  // namespace poise::artifacts
