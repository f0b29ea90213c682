#include "core/prediction/mixer/mixer_config.h"

#include <fmt/format.h>

namespace poise::prediction {

std::vector<base::Field> MixerConfig::Fields() {
  return {base::Number("past_frames", &past_frames, 2, 1000),
          base::Number("future_frames", &future_frames, 1, 1000),
          base::Number("width", &width, 1, 4096),
          base::Number("groups", &groups, 1, 256),
          base::Number("hidden", &hidden, 1, 16384),
          base::Number("blocks", &blocks, 1, 256),
          base::Number("dropout", &dropout, 0, 0.9)};
}

Status MixerConfig::Validate() const {
  if (width % groups == 0) return absl::OkStatus();
  return base::InvalidArgument("CONFIG_VALUE_OUT_OF_RANGE", "mixer.groups",
                               fmt::format("{} features are no {} groups", width, groups));
}

}  // namespace poise::prediction
