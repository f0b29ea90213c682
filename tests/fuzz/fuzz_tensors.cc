#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/artifacts/model_artifact.h"
#include "core/base/tensor_file.h"
#include "core/motion/dataset/clip_set_file.h"

// Weights, checkpoints, data sets and models: all are safetensors files.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const std::string_view data(reinterpret_cast<const char*>(bytes), size);
  const auto file = poise::base::DecodeTensors(data, "fuzz");
  if (!file.ok()) return 0;
  // What was read can be written, and means the same when it is read again.
  const std::string written = poise::base::EncodeTensors(*file);
  const auto again = poise::base::DecodeTensors(written, "again");
  if (!again.ok() || poise::base::EncodeTensors(*again) != written) std::abort();
  poise::motion::DecodeClipSet(data, "fuzz").status().IgnoreError();
  poise::artifacts::UnpackModel(data, "fuzz").status().IgnoreError();
  return 0;
}
