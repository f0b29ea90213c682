#ifndef POISE_CORE_PREDICTION_TENSORS_DCT_H_
#define POISE_CORE_PREDICTION_TENSORS_DCT_H_

#include <torch/torch.h>

namespace poise::prediction {

/// Orthonormal DCT-II matrix, (coefficient, frame). Source: reference sec. 4.2.
torch::Tensor DctMatrix(int frames);

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_TENSORS_DCT_H_
