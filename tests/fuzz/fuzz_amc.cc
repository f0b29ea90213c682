#include "tests/fuzz/fuzz_clip.h"

// The ASF's text, a line "=====", then the AMC's text: both readers see hostile input.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  constexpr std::string_view kBorder = "=====\n";
  const std::string_view data(reinterpret_cast<const char*>(bytes), size);
  const size_t border = data.find(kBorder);
  if (border == std::string_view::npos) return 0;
  poise::fuzz::CheckClip(poise::motion::DecodeClip("fuzz.amc", data.substr(border + kBorder.size()),
                                                   poise::motion::ClipFormat::kAmc, {},
                                                   data.substr(0, border)));
  return 0;
}
