#ifndef POISE_CORE_MOTION_IO_NPY_ARRAY_H_
#define POISE_CORE_MOTION_IO_NPY_ARRAY_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/status.h"

namespace poise::motion {

/// What the head of a NumPy array file says (format versions 1, 2 and 3).
struct NpyHeader {
  char kind = 'f';  ///< 'f' float, 'i' or 'u' integer; of little-endian numbers
  int item_bytes = 8;
  bool fortran_order = false;
  std::vector<int64_t> shape;  ///< empty for a single number
  size_t data_offset = 0;      ///< where the numbers begin
  int64_t num_items = 1;       ///< product of the shape
};

/// Errors: kInvalidArgument MALFORMED_NPZ, TOO_LARGE, beginning with `where` ("walk.npz: entry
/// 'poses'").
StatusOr<NpyHeader> ParseNpyHeader(std::string_view where, std::string_view bytes);

/// The numbers of an array in row-major order. Accepts f4, f8 and integers of 1 to 8 bytes.
/// Errors: as above, also when the data is shorter or longer than the shape, or a number is not
/// finite.
StatusOr<std::vector<double>> ReadNpyNumbers(std::string_view where, const NpyHeader& header,
                                             std::string_view bytes);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_IO_NPY_ARRAY_H_
