#include "core/prediction/potr/potr_config.h"

#include <fmt/format.h>

#include <cmath>

namespace poise::prediction {

std::vector<base::Field> PotrConfig::Fields() {
  return {base::Number("past_frames", &past_frames, 3, 1000),
          base::Number("future_frames", &future_frames, 1, 1000),
          base::Flag("root", &root),
          base::Number("node_width", &node_width, 1, 4096),
          base::Number("joint_width", &joint_width, 1, 4096),
          base::Number("width", &width, 2, 4096),
          base::Number("heads", &heads, 1, 64),
          base::Number("layers", &layers, 1, 64),
          base::Number("hidden", &hidden, 1, 16384),
          base::Number("dropout", &dropout, 0, 0.9),
          base::Flag("residual", &residual)};
}

Status PotrConfig::Validate() const {
  if (width % 2 == 0 && width % heads == 0) return absl::OkStatus();
  return base::InvalidArgument("CONFIG_VALUE_OUT_OF_RANGE", "potr.width",
                               fmt::format("{} features are odd or no {} heads", width, heads));
}

std::vector<float> PotrPositions(int frames, int width) {
  std::vector<float> positions;
  for (int frame = 0; frame < frames; ++frame) {
    for (int feature = 0; feature < width; ++feature) {
      const double power = 2.0 * (feature / 2) / width;
      const double angle = 10.0 * frame / std::pow(500.0, power);
      positions.push_back(static_cast<float>(feature % 2 == 0 ? std::sin(angle) : std::cos(angle)));
    }
  }
  return positions;
}

}  // namespace poise::prediction
