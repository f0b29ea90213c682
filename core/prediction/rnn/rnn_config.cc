#include "core/prediction/rnn/rnn_config.h"

namespace poise::prediction {

std::vector<base::Field> RnnConfig::Fields() {
  return {base::Number("past_frames", &past_frames, 2, 1000),
          base::Number("future_frames", &future_frames, 1, 1000),
          base::Number("hidden", &hidden, 1, 16384),
          base::Flag("root", &root),
          base::Flag("normalised", &normalised),
          base::Flag("squared", &squared)};
}

}  // namespace poise::prediction
