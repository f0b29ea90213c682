// Replays the seeds of the fuzz targets and the inputs that once broke a reader.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size);

namespace poise {
namespace {

TEST(SeedsTest, NoSeedBreaksItsReader) {
  int inputs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(POISE_SEEDS)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string data(std::istreambuf_iterator<char>(file), {});
    LLVMFuzzerTestOneInput(reinterpret_cast<const uint8_t*>(data.data()), data.size());
    ++inputs;
  }
  EXPECT_GT(inputs, 0);
}

}  // namespace
}  // namespace poise
