#include "core/prediction/simlpe/simlpe_config.h"

#include <fmt/format.h>

namespace poise::prediction {

std::vector<base::Field> SimlpeConfig::Fields() {
  return {base::Number("past_frames", &past_frames, 2, 1000),
          base::Number("future_frames", &future_frames, 1, 1000),
          base::Number("blocks", &blocks, 1, 256), base::Flag("root", &root)};
}

Status SimlpeConfig::Validate() const {
  if (future_frames <= past_frames) return absl::OkStatus();
  return base::InvalidArgument("CONFIG_VALUE_OUT_OF_RANGE", "simlpe.future_frames",
                               fmt::format("{} frames of the past cannot become {} of the future",
                                           past_frames, future_frames));
}

}  // namespace poise::prediction
