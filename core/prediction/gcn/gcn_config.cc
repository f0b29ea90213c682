#include "core/prediction/gcn/gcn_config.h"

#include <fmt/format.h>

namespace poise::prediction {

std::vector<base::Field> GcnConfig::Fields() {
  return {base::Number("past_frames", &past_frames, 2, 1000),
          base::Number("future_frames", &future_frames, 1, 1000),
          base::Number("coefficients", &coefficients, 0, 2000),
          base::Flag("root", &root),
          base::Flag("moving", &moving),
          base::Number("width", &width, 1, 4096),
          base::Number("blocks", &blocks, 1, 256),
          base::Number("dropout", &dropout, 0, 0.9)};
}

Status GcnConfig::Validate() const {
  if (coefficients <= frames()) return absl::OkStatus();
  return base::InvalidArgument(
      "CONFIG_VALUE_OUT_OF_RANGE", "gcn.coefficients",
      fmt::format("{} frames have no {} coefficients", frames(), coefficients));
}

}  // namespace poise::prediction
