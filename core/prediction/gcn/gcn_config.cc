#include "core/prediction/gcn/gcn_config.h"

namespace poise::prediction {

std::vector<base::Field> GcnConfig::Fields() {
  return {base::Number("past_frames", &past_frames, 2, 1000),
          base::Number("future_frames", &future_frames, 1, 1000),
          base::Number("width", &width, 1, 4096), base::Number("blocks", &blocks, 1, 256),
          base::Number("dropout", &dropout, 0, 0.9)};
}

}  // namespace poise::prediction
