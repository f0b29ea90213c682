#include "core/motion/io/npy_array.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "core/motion/io/text_scanner.h"

namespace poise::motion {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr size_t kLongestHeader = 64 * 1024;
constexpr size_t kMostDimensions = 8;
constexpr int64_t kMostItems = 24 * 1024 * 1024;  // 192 MB as double

Status Malformed(std::string_view where, std::string_view problem) {
  return base::InvalidArgument("MALFORMED_NPZ", "", fmt::format("{}: {}", where, problem));
}

// What follows `'key':` in the header's dictionary.
StatusOr<std::string_view> ValueOf(std::string_view where, std::string_view dictionary,
                                   std::string_view key) {
  for (const char quote : {'\'', '"'}) {
    const std::string quoted = fmt::format("{}{}{}", quote, key, quote);
    const size_t at = dictionary.find(quoted);
    if (at == std::string_view::npos) continue;
    std::string_view rest = dictionary.substr(at + quoted.size());
    const size_t begin = rest.find_first_not_of(" :");
    if (begin == std::string_view::npos) break;
    return rest.substr(begin);
  }
  return Malformed(
      where, fmt::format("expected '{}' in the array's header, found {}", key, Quoted(dictionary)));
}

// "'<f8'" -> kind and size. One-byte integers have '|' for their byte order.
Status ParseType(std::string_view where, std::string_view value, NpyHeader& header) {
  const bool quoted =
      value.size() >= 5 && (value[0] == '\'' || value[0] == '"') && value[4] == value[0];
  const std::string_view type = quoted ? value.substr(1, 3) : std::string_view();
  if (quoted && (type[0] == '<' || type[0] == '|')) {
    header.kind = type[1];
    header.item_bytes = type[2] - '0';
    const int bytes = header.item_bytes;
    const bool is_integer = header.kind == 'i' || header.kind == 'u';
    if (header.kind == 'f' && (bytes == 4 || bytes == 8)) return absl::OkStatus();
    if (is_integer && (bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8)) {
      return absl::OkStatus();
    }
  }
  return Malformed(where, fmt::format("expected little-endian numbers ('<f4', '<f8' or integers), "
                                      "found the type {}",
                                      Quoted(value.substr(0, value.find(',')))));
}

Status ParseShape(std::string_view where, std::string_view value, NpyHeader& header) {
  const std::string_view tuple = value.substr(0, value.find(')'));
  const auto malformed = [&] {
    return Malformed(where,
                     fmt::format("expected a shape like (120, 156), found {}", Quoted(tuple)));
  };
  if (!tuple.starts_with('(') || tuple.size() == value.size()) return malformed();
  const char* at = tuple.data() + 1;
  const char* end = tuple.data() + tuple.size();
  while (true) {
    while (at != end && (*at == ' ' || *at == ',')) ++at;
    if (at == end) return absl::OkStatus();
    int64_t length = 0;
    const auto [stop, error] = std::from_chars(at, end, length);
    if (error != std::errc() || length < 0 || header.shape.size() >= kMostDimensions) {
      return malformed();
    }
    at = stop;
    if (at != end && *at == 'L') ++at;  // written by Python 2
    header.shape.push_back(length);
    if (length > 0 && header.num_items > kMostItems / length) {
      return base::InvalidArgument(
          "TOO_LARGE", "",
          fmt::format("{}: the shape {}) has more than the {} numbers that are accepted", where,
                      tuple, kMostItems));
    }
    header.num_items *= length;
  }
}

// One number, whatever its alignment.
template <typename T>
double Load(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return static_cast<double>(value);
}

double LoadItem(const NpyHeader& header, const char* at) {
  const bool is_signed = header.kind == 'i';
  switch (header.item_bytes) {
    case 1:
      return is_signed ? Load<int8_t>(at) : Load<uint8_t>(at);
    case 2:
      return is_signed ? Load<int16_t>(at) : Load<uint16_t>(at);
    case 4:
      if (header.kind == 'f') return Load<float>(at);
      return is_signed ? Load<int32_t>(at) : Load<uint32_t>(at);
    default:
      if (header.kind == 'f') return Load<double>(at);
      return is_signed ? Load<int64_t>(at) : Load<uint64_t>(at);
  }
}

}  // namespace

StatusOr<NpyHeader> ParseNpyHeader(std::string_view where, std::string_view bytes) {
  if (!bytes.starts_with(kMagic) || bytes.size() < kMagic.size() + 4) {
    return Malformed(where, fmt::format("expected a NumPy array, found {}",
                                        Quoted(bytes.substr(0, kMagic.size()))));
  }
  const int version = static_cast<unsigned char>(bytes[6]);
  if (version < 1 || version > 3) {
    return Malformed(where,
                     fmt::format("expected NumPy format version 1, 2 or 3, found {}", version));
  }
  const size_t length_bytes = version == 1 ? 2 : 4;
  const size_t text_begin = 8 + length_bytes;
  size_t length = 0;
  for (size_t i = 0; i < length_bytes && 8 + i < bytes.size(); ++i) {
    length |= static_cast<size_t>(static_cast<unsigned char>(bytes[8 + i])) << (8 * i);
  }
  if (bytes.size() < text_begin || length > kLongestHeader || length > bytes.size() - text_begin) {
    return Malformed(where, fmt::format("expected a header of {} bytes, found {} bytes in all",
                                        length, bytes.size()));
  }
  const std::string_view dictionary = bytes.substr(text_begin, length);
  NpyHeader header;
  header.data_offset = text_begin + length;
  POISE_ASSIGN_OR_RETURN(const std::string_view type, ValueOf(where, dictionary, "descr"));
  POISE_RETURN_IF_ERROR(ParseType(where, type, header));
  POISE_ASSIGN_OR_RETURN(const std::string_view order, ValueOf(where, dictionary, "fortran_order"));
  header.fortran_order = order.starts_with("True");
  if (!header.fortran_order && !order.starts_with("False")) {
    return Malformed(where, fmt::format("expected fortran_order True or False, found {}",
                                        Quoted(order.substr(0, order.find(',')))));
  }
  POISE_ASSIGN_OR_RETURN(const std::string_view shape, ValueOf(where, dictionary, "shape"));
  POISE_RETURN_IF_ERROR(ParseShape(where, shape, header));
  return header;
}

StatusOr<std::vector<double>> ReadNpyNumbers(std::string_view where, const NpyHeader& header,
                                             std::string_view bytes) {
  const std::string_view data = bytes.substr(std::min(header.data_offset, bytes.size()));
  if (data.size() != static_cast<size_t>(header.num_items) * header.item_bytes) {
    return Malformed(where, fmt::format("expected {} numbers of {} bytes, found {} bytes",
                                        header.num_items, header.item_bytes, data.size()));
  }
  std::vector<double> numbers(header.num_items);
  // In Fortran order the first index runs fastest: (rows, the rest) is read column by column.
  const size_t rows = header.fortran_order && !header.shape.empty() ? header.shape[0] : 1;
  const size_t columns = rows == 0 ? 0 : numbers.size() / rows;
  if (header.fortran_order && header.shape.size() > 2) {
    return Malformed(where, fmt::format("expected at most two dimensions in Fortran order, found "
                                        "{}",
                                        header.shape.size()));
  }
  for (size_t i = 0; i < numbers.size(); ++i) {
    const size_t place = header.fortran_order ? i % rows * columns + i / rows : i;
    const double value = LoadItem(header, data.data() + i * header.item_bytes);
    if (!std::isfinite(value)) {
      return Malformed(where,
                       fmt::format("expected finite numbers, found {} at place {}", value, place));
    }
    numbers[place] = value;
  }
  return numbers;
}

}  // namespace poise::motion
