#include "core/api/augment_spec.h"

#include <fmt/format.h>

namespace poise::api {

Status AugmentSpec::Validate() const {
  if (sources.empty()) {
    return base::InvalidArgument("EMPTY_REQUEST", "sources", "sources is empty: nothing to vary");
  }
  if (sources.size() > kMaxSources) {
    return base::InvalidArgument(
        "TOO_MANY_SOURCES", "sources",
        fmt::format("request has {} sources, at most {}", sources.size(), kMaxSources));
  }
  if (variants_per_source < 1 || variants_per_source > kMaxVariants) {
    return base::InvalidArgument("BAD_VARIANT_COUNT", "variants_per_source",
                                 fmt::format("variants_per_source is {}, expected 1 to {}",
                                             variants_per_source, kMaxVariants));
  }
  if (preset != "recommended" && preset != "paper") {
    return base::InvalidArgument(
        "UNKNOWN_PRESET", "preset",
        fmt::format("unknown preset '{}', expected recommended or paper", preset));
  }
  return absl::OkStatus();
}

}  // namespace poise::api
