#include "core/learning/rl/tensor_record.h"

#include <ATen/ATen.h>
#include <fmt/format.h>

#include <cstring>

namespace poise::rl {
namespace {

base::ElementType TypeOf(const at::Tensor& tensor) {
  if (tensor.scalar_type() == at::kLong) return base::ElementType::kInt64;
  return tensor.scalar_type() == at::kDouble ? base::ElementType::kFloat64
                                             : base::ElementType::kFloat32;
}

}  // namespace

base::TensorRecord ToRecord(const at::Tensor& tensor) {
  base::TensorRecord record;
  record.type = TypeOf(tensor);
  record.shape = tensor.sizes().vec();
  record.bytes.assign(static_cast<const char*>(tensor.data_ptr()), tensor.nbytes());
  return record;
}

Status CopyRecord(const base::TensorFile& file, const std::string& name, const at::Tensor& tensor) {
  POISE_ASSIGN_OR_RETURN(const base::TensorRecord* record, file.Find(name));
  const base::ElementType type = TypeOf(tensor);
  if (record->type != type || record->shape != tensor.sizes().vec()) {
    return base::InvalidArgument(
        "WRONG_SHAPE", "",
        fmt::format("{} is {} {}, expected {} {}", name, base::ElementTypeName(record->type),
                    base::ShapeText(record->shape), base::ElementTypeName(type),
                    base::ShapeText(tensor.sizes().vec())));
  }
  std::memcpy(tensor.data_ptr(), record->bytes.data(), record->bytes.size());
  return absl::OkStatus();
}

}  // namespace poise::rl
