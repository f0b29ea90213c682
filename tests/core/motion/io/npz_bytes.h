#ifndef POISE_TESTS_CORE_MOTION_IO_NPZ_BYTES_H_
#define POISE_TESTS_CORE_MOTION_IO_NPZ_BYTES_H_

#include <string>
#include <string_view>
#include <vector>

/// NumPy archives that tests write themselves, byte by byte.
namespace poise::testing {

/// A NumPy array: version 1 to 3, `type` like "<f8", `shape` like "(2, 3)".
std::string Npy(std::string_view type, std::string_view shape, std::string_view data,
                int version = 1, bool fortran_order = false);

/// The bytes of numbers as they lie in memory.
template <typename T>
std::string Bytes(const std::vector<T>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)};
}

struct ZipEntry {
  std::string name;
  std::string data;
};

enum class Packing { kStored, kStoredZip64, kDeflated };

std::string Zip(const std::vector<ZipEntry>& entries, Packing packing);

}  // namespace poise::testing

#endif  // POISE_TESTS_CORE_MOTION_IO_NPZ_BYTES_H_
