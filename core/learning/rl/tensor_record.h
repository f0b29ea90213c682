#ifndef POISE_CORE_LEARNING_RL_TENSOR_RECORD_H_
#define POISE_CORE_LEARNING_RL_TENSOR_RECORD_H_

#include <ATen/core/Tensor.h>

#include <string>

#include "core/base/status.h"
#include "core/base/tensor_file.h"

namespace poise::rl {

/// A copy of a contiguous tensor of float, double or int64.
base::TensorRecord ToRecord(const at::Tensor& tensor);

/// Fills `tensor`, which is contiguous, with the one of that name.
/// Errors: kInvalidArgument MISSING_TENSOR, WRONG_SHAPE (or another type).
Status CopyRecord(const base::TensorFile& file, const std::string& name, const at::Tensor& tensor);

}  // namespace poise::rl

#endif  // POISE_CORE_LEARNING_RL_TENSOR_RECORD_H_
