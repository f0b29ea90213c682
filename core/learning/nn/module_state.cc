#include "core/learning/nn/module_state.h"

#include <fmt/format.h>

#include <cstring>
#include <string>

namespace poise::learning {
namespace {

using base::ElementType;
using base::ShapeText;
using base::TensorRecord;

torch::ScalarType ScalarTypeOf(ElementType type) {
  switch (type) {
    case ElementType::kFloat32:
      return torch::kFloat32;
    case ElementType::kFloat64:
      return torch::kFloat64;
    case ElementType::kInt64:
      return torch::kInt64;
    case ElementType::kUint8:
      break;
  }
  return torch::kUInt8;
}

std::span<const int64_t> ShapeOf(const torch::Tensor& tensor) {
  return {tensor.sizes().data(), tensor.sizes().size()};
}

template <typename Visit>
Status ForEachTensor(const torch::nn::Module& module, Visit visit) {
  for (const auto& item : module.named_parameters()) {
    POISE_RETURN_IF_ERROR(visit(item.key(), item.value()));
  }
  for (const auto& item : module.named_buffers()) {
    POISE_RETURN_IF_ERROR(visit(item.key(), item.value()));
  }
  return absl::OkStatus();
}

Status NotFinite(std::string_view what, std::string_view kind, std::string_view name) {
  return base::MakeError(absl::StatusCode::kOutOfRange, "NOT_FINITE", "",
                         fmt::format("{}: {} '{}' is not finite", what, kind, name));
}

bool IsFinite(const torch::Tensor& tensor) {
  return !tensor.is_floating_point() || torch::isfinite(tensor).all().item<bool>();
}

}  // namespace

StatusOr<TensorRecord> ToRecord(const torch::Tensor& tensor) {
  const torch::Tensor plain = tensor.detach().contiguous();
  TensorRecord record;
  for (const ElementType type :
       {ElementType::kFloat32, ElementType::kFloat64, ElementType::kInt64, ElementType::kUint8}) {
    if (plain.scalar_type() != ScalarTypeOf(type)) continue;
    record.type = type;
    record.shape.assign(plain.sizes().begin(), plain.sizes().end());
    record.bytes.assign(static_cast<const char*>(plain.data_ptr()), plain.nbytes());
    return record;
  }
  return base::Internal("UNKNOWN_TENSOR_TYPE", fmt::format("tensors of type {} are not stored",
                                                           torch::toString(plain.scalar_type())));
}

torch::Tensor FromRecord(const TensorRecord& record) {
  torch::Tensor tensor = torch::empty(record.shape, ScalarTypeOf(record.type));
  if (!record.bytes.empty()) {
    std::memcpy(tensor.data_ptr(), record.bytes.data(), record.bytes.size());
  }
  return tensor;
}

Status AppendState(const torch::nn::Module& module, std::string_view prefix,
                   base::TensorFile& file) {
  return ForEachTensor(module, [&](const std::string& name, const torch::Tensor& tensor) -> Status {
    POISE_ASSIGN_OR_RETURN(file.tensors[fmt::format("{}{}", prefix, name)], ToRecord(tensor));
    return absl::OkStatus();
  });
}

Status LoadState(const base::TensorFile& file, std::string_view prefix, torch::nn::Module& module) {
  const torch::NoGradGuard no_gradient;
  size_t loaded = 0;
  const auto load = [&](const std::string& name, torch::Tensor tensor) -> Status {
    const std::string full = fmt::format("{}{}", prefix, name);
    POISE_ASSIGN_OR_RETURN(const TensorRecord* record, file.Find(full));
    if (ScalarTypeOf(record->type) != tensor.scalar_type() ||
        !std::ranges::equal(record->shape, ShapeOf(tensor))) {
      return base::InvalidArgument(
          "WRONG_SHAPE", "",
          fmt::format("tensor '{}' is {} {}, the network has {} {}", full,
                      base::ElementTypeName(record->type), ShapeText(record->shape),
                      torch::toString(tensor.scalar_type()), ShapeText(ShapeOf(tensor))));
    }
    tensor.copy_(FromRecord(*record));
    ++loaded;
    return absl::OkStatus();
  };
  POISE_RETURN_IF_ERROR(ForEachTensor(module, load));
  size_t stored = 0;
  for (const auto& [name, record] : file.tensors) stored += name.starts_with(prefix);
  if (stored == loaded) return absl::OkStatus();
  const auto parameters = module.named_parameters();
  const auto buffers = module.named_buffers();
  for (const auto& [name, record] : file.tensors) {
    if (!name.starts_with(prefix)) continue;
    const std::string key = name.substr(prefix.size());
    if (parameters.contains(key) || buffers.contains(key)) continue;
    return base::InvalidArgument("UNKNOWN_TENSOR", "",
                                 fmt::format("the network has no tensor '{}'", name));
  }
  return absl::OkStatus();
}

Status CheckFinite(const torch::nn::Module& module, std::string_view what) {
  return ForEachTensor(module, [&](const std::string& name, const torch::Tensor& tensor) -> Status {
    return IsFinite(tensor) ? absl::OkStatus() : NotFinite(what, "tensor", name);
  });
}

Status CheckGradientsFinite(const torch::nn::Module& module, std::string_view what) {
  for (const auto& item : module.named_parameters()) {
    const torch::Tensor gradient = item.value().grad();
    if (gradient.defined() && !IsFinite(gradient)) {
      return NotFinite(what, "the gradient of", item.key());
    }
  }
  return absl::OkStatus();
}

}  // namespace poise::learning
