#ifndef POISE_CORE_LEARNING_NN_MODULE_STATE_H_
#define POISE_CORE_LEARNING_NN_MODULE_STATE_H_

#include <torch/torch.h>

#include <string_view>

#include "core/base/status.h"
#include "core/base/tensor_file.h"

/// Between networks and files: what a network learned is its parameters and buffers, by name.
namespace poise::learning {

/// Copies a tensor of floats, doubles, int64 or bytes. Errors: kInternal UNKNOWN_TENSOR_TYPE.
StatusOr<base::TensorRecord> ToRecord(const torch::Tensor& tensor);
torch::Tensor FromRecord(const base::TensorRecord& record);

/// Adds every parameter and buffer as `prefix` + its name ("decoder.lstm.weight_ih_l0").
Status AppendState(const torch::nn::Module& module, std::string_view prefix,
                   base::TensorFile& file);

/// Copies them back into `module`, which must have been built like the saved one. On error some may
/// already be copied. Errors: kInvalidArgument naming the tensor: MISSING_TENSOR, WRONG_SHAPE (or
/// type), UNKNOWN_TENSOR (below `prefix`, but of no parameter).
Status LoadState(const base::TensorFile& file, std::string_view prefix, torch::nn::Module& module);

/// Errors: kOutOfRange NOT_FINITE naming the first parameter or buffer with a NaN or an infinity.
Status CheckFinite(const torch::nn::Module& module, std::string_view what);

/// The same for gradients.
Status CheckGradientsFinite(const torch::nn::Module& module, std::string_view what);

}  // namespace poise::learning

#endif  // POISE_CORE_LEARNING_NN_MODULE_STATE_H_
