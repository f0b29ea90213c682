#ifndef POISE_CORE_BASE_TENSOR_FILE_H_
#define POISE_CORE_BASE_TENSOR_FILE_H_

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/status.h"

/// Named arrays in one file, for weights and checkpoints: the safetensors format, which any
/// language reads with a few lines and which needs no LibTorch:
///
///   8 bytes   N, the length of the header, little-endian
///   N bytes   JSON: {"__metadata__": {text: text}, "NAME": {"dtype": "F32", "shape": [..],
///             "data_offsets": [begin, end]}, ...}; offsets count from the end of the header
///   the rest  the numbers, little-endian, row by row, tensor after tensor without gaps
namespace poise::base {

enum class ElementType { kFloat32, kFloat64, kInt64, kUint8 };

/// "F32", "F64", "I64", "U8", as in the header.
const char* ElementTypeName(ElementType type);
int ElementBytes(ElementType type);

/// One array: `bytes` are its elements, little-endian, row by row.
struct TensorRecord {
  ElementType type = ElementType::kFloat32;
  std::vector<int64_t> shape;
  std::string bytes;

  int64_t num_elements() const;
  static TensorRecord FromFloats(std::vector<int64_t> shape, std::span<const float> values);
};

/// What a file holds. Names are sorted, so the same content gives the same bytes.
struct TensorFile {
  std::map<std::string, TensorRecord> tensors;
  std::map<std::string, std::string> metadata;

  /// The tensor of that name. Errors: kInvalidArgument MISSING_TENSOR.
  StatusOr<const TensorRecord*> Find(const std::string& name) const;
  /// Its numbers, for inference without LibTorch.
  /// Errors: kInvalidArgument MISSING_TENSOR, WRONG_SHAPE (another shape, or no F32).
  StatusOr<std::vector<float>> Floats(const std::string& name,
                                      std::span<const int64_t> shape) const;
};

/// "(256, 99)", for messages.
std::string ShapeText(std::span<const int64_t> shape);

std::string EncodeTensors(const TensorFile& file);

/// `what` names the bytes in messages.
/// Errors: kInvalidArgument MALFORMED_TENSORS (cut off, overlapping, unknown types, sizes that do
/// not fit the shape).
StatusOr<TensorFile> DecodeTensors(std::string_view bytes, std::string_view what);

}  // namespace poise::base

#endif  // POISE_CORE_BASE_TENSOR_FILE_H_
