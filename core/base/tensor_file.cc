#include "core/base/tensor_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>

#include "core/base/json.h"

namespace poise::base {
namespace {

// The bytes of numbers are copied as they lie in memory.
static_assert(std::endian::native == std::endian::little);

constexpr const char* kMetadata = "__metadata__";
constexpr size_t kLengthBytes = 8;
// The numbers begin at a multiple of this, so that a mapped file can be read in place.
constexpr size_t kAlignment = 8;

struct TypeEntry {
  ElementType type;
  const char* name;
  int bytes;
};
constexpr std::array<TypeEntry, 4> kTypes = {{{ElementType::kFloat32, "F32", 4},
                                              {ElementType::kFloat64, "F64", 8},
                                              {ElementType::kInt64, "I64", 8},
                                              {ElementType::kUint8, "U8", 1}}};

const TypeEntry& EntryOf(ElementType type) { return kTypes[static_cast<size_t>(type)]; }

Status Malformed(std::string_view what, std::string_view message) {
  return InvalidArgument("MALFORMED_TENSORS", "", fmt::format("{}: {}", what, message));
}

// Number of elements, or nullopt for what is no shape or overflows.
std::optional<int64_t> CountElements(std::span<const int64_t> shape) {
  int64_t count = 1;
  for (const int64_t size : shape) {
    if (size < 0 || __builtin_mul_overflow(count, size, &count)) return std::nullopt;
  }
  return count;
}

StatusOr<TensorRecord> DecodeRecord(const std::string& name, const Json& entry,
                                    std::string_view numbers, std::string_view what) {
  TensorRecord record;
  int64_t begin = 0, end = 0;
  try {
    const std::string dtype = entry.at("dtype");
    const auto type = std::find_if(kTypes.begin(), kTypes.end(),
                                   [&](const TypeEntry& known) { return dtype == known.name; });
    if (type == kTypes.end()) {
      return Malformed(what, fmt::format("'{}' has numbers of type '{}', expected F32, F64, I64 or "
                                         "U8",
                                         name, dtype));
    }
    record.type = type->type;
    for (const Json& size : entry.at("shape").get_ref<const Json::array_t&>()) {
      record.shape.push_back(IntegerFrom<int64_t>(size));
    }
    begin = IntegerFrom<int64_t>(entry.at("data_offsets").at(0));
    end = IntegerFrom<int64_t>(entry.at("data_offsets").at(1));
  } catch (const Json::exception&) {
    return Malformed(what, fmt::format("'{}' needs dtype, shape and data_offsets", name));
  }
  const std::optional<int64_t> count = CountElements(record.shape);
  const int64_t size = static_cast<int64_t>(numbers.size());
  if (!count || begin < 0 || end < begin || end > size ||
      (end - begin) % ElementBytes(record.type) != 0 ||
      (end - begin) / ElementBytes(record.type) != *count) {
    return Malformed(what, fmt::format("'{}' of shape {} lies at bytes {} to {} of {}", name,
                                       ShapeText(record.shape), begin, end, size));
  }
  record.bytes = numbers.substr(begin, end - begin);
  return record;
}

}  // namespace

const char* ElementTypeName(ElementType type) { return EntryOf(type).name; }
int ElementBytes(ElementType type) { return EntryOf(type).bytes; }

std::string ShapeText(std::span<const int64_t> shape) {
  return fmt::format("({})", fmt::join(shape, ", "));
}

int64_t TensorRecord::num_elements() const {
  return static_cast<int64_t>(bytes.size()) / ElementBytes(type);
}

TensorRecord TensorRecord::FromFloats(std::vector<int64_t> shape, std::span<const float> values) {
  TensorRecord record{.type = ElementType::kFloat32, .shape = std::move(shape), .bytes = {}};
  record.bytes.assign(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  return record;
}

StatusOr<const TensorRecord*> TensorFile::Find(const std::string& name) const {
  const auto found = tensors.find(name);
  if (found != tensors.end()) return &found->second;
  return InvalidArgument("MISSING_TENSOR", "",
                         fmt::format("there is no tensor '{}' among {}", name, tensors.size()));
}

StatusOr<std::vector<float>> TensorFile::Floats(const std::string& name,
                                                std::span<const int64_t> shape) const {
  POISE_ASSIGN_OR_RETURN(const TensorRecord* record, Find(name));
  if (record->type != ElementType::kFloat32 || !std::ranges::equal(record->shape, shape)) {
    return InvalidArgument(
        "WRONG_SHAPE", "",
        fmt::format("tensor '{}' is {} {}, expected F32 {}", name, ElementTypeName(record->type),
                    ShapeText(record->shape), ShapeText(shape)));
  }
  std::vector<float> values(record->num_elements());
  std::memcpy(values.data(), record->bytes.data(), record->bytes.size());
  return values;
}

std::string EncodeTensors(const TensorFile& file) {
  Json header = Json::object();
  if (!file.metadata.empty()) header[kMetadata] = file.metadata;
  size_t offset = 0;
  for (const auto& [name, record] : file.tensors) {
    header[name] = {{"dtype", ElementTypeName(record.type)},
                    {"shape", record.shape},
                    {"data_offsets", {offset, offset + record.bytes.size()}}};
    offset += record.bytes.size();
  }
  std::string text = header.dump();
  text.append((kAlignment - text.size() % kAlignment) % kAlignment, ' ');
  const uint64_t length = text.size();
  std::string bytes(kLengthBytes, '\0');
  std::memcpy(bytes.data(), &length, kLengthBytes);
  bytes.reserve(bytes.size() + text.size() + offset);
  bytes += text;
  for (const auto& [name, record] : file.tensors) bytes += record.bytes;
  return bytes;
}

StatusOr<TensorFile> DecodeTensors(std::string_view bytes, std::string_view what) {
  uint64_t length = 0;
  if (bytes.size() < kLengthBytes) return Malformed(what, "too short for a header");
  std::memcpy(&length, bytes.data(), kLengthBytes);
  if (length > bytes.size() - kLengthBytes) {
    return Malformed(what, fmt::format("the header has {} bytes, only {} are there", length,
                                       bytes.size() - kLengthBytes));
  }
  POISE_ASSIGN_OR_RETURN(const Json header, ParseJson(bytes.substr(kLengthBytes, length), what));
  if (!header.is_object()) return Malformed(what, "the header is no JSON object");
  const std::string_view numbers = bytes.substr(kLengthBytes + length);
  TensorFile file;
  size_t used = 0;
  for (const auto& [name, entry] : header.items()) {
    if (name == kMetadata) {
      if (!entry.is_object()) return Malformed(what, "the metadata is no JSON object");
      for (const auto& [key, value] : entry.items()) {
        if (!value.is_string())
          return Malformed(what, fmt::format("metadata '{}' is no text", key));
        file.metadata[key] = value;
      }
      continue;
    }
    POISE_ASSIGN_OR_RETURN(TensorRecord record, DecodeRecord(name, entry, numbers, what));
    used += record.bytes.size();
    file.tensors.emplace(name, std::move(record));
  }
  if (used != numbers.size()) {
    return Malformed(what, fmt::format("the tensors have {} bytes together, the file has {}", used,
                                       numbers.size()));
  }
  return file;
}

}  // namespace poise::base
