#include "core/motion/io/npy_array.h"
#include "tests/fuzz/fuzz_clip.h"

// A zip archive as it is, or the bytes of an array inside one: checksums would keep most changes of
// an archive from ever reaching the array's reader.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const std::string_view data(reinterpret_cast<const char*>(bytes), size);
  if (data.starts_with("PK")) {
    poise::fuzz::CheckClip(
        poise::motion::DecodeClip("fuzz.npz", data, poise::motion::ClipFormat::kNpz));
    return 0;
  }
  const auto header = poise::motion::ParseNpyHeader("fuzz.npy", data);
  if (!header.ok()) return 0;
  const auto numbers = poise::motion::ReadNpyNumbers("fuzz.npy", *header, data);
  if (numbers.ok() && static_cast<int64_t>(numbers->size()) != header->num_items) std::abort();
  return 0;
}
