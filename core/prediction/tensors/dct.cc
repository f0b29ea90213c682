#include "core/prediction/tensors/dct.h"

#include <cmath>
#include <numbers>

namespace poise::prediction {

torch::Tensor DctMatrix(int frames) {
  torch::Tensor matrix = torch::empty({frames, frames});
  auto entry = matrix.accessor<float, 2>();
  for (int k = 0; k < frames; ++k) {
    const double weight = std::sqrt((k == 0 ? 1.0 : 2.0) / frames);
    for (int i = 0; i < frames; ++i) {
      entry[k][i] =
          static_cast<float>(weight * std::cos(std::numbers::pi * (i + 0.5) * k / frames));
    }
  }
  return matrix;
}

}  // namespace poise::prediction
