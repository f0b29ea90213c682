#include "tests/fuzz/fuzz_clip.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const std::string_view data(reinterpret_cast<const char*>(bytes), size);
  poise::fuzz::CheckClip(
      poise::motion::DecodeClip("fuzz.npz", data, poise::motion::ClipFormat::kNpz));
  return 0;
}
