#include "core/base/tensor_file.h"

#include <gtest/gtest.h>

#include <cstring>

#include "core/base/random.h"

namespace poise::base {
namespace {

// Written by hand after the description of the safetensors format.
std::string HandMadeFile() {
  const std::string header =
      R"({"__metadata__":{"family":"vae"},"a":{"dtype":"F32","shape":[2,1],"data_offsets":[0,8]},)"
      R"("step":{"dtype":"I64","shape":[],"data_offsets":[8,16]}})";
  std::string bytes(8, '\0');
  bytes[0] = static_cast<char>(header.size());
  bytes += header;
  bytes += std::string("\x00\x00\x80\x3f\x00\x00\x00\xc0", 8);  // 1, -2
  bytes += std::string("\x07\x00\x00\x00\x00\x00\x00\x00", 8);
  return bytes;
}

TEST(TensorFileTest, ReadsAFileThatWasWrittenByHand) {
  const auto file = DecodeTensors(HandMadeFile(), "weights");
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_EQ(file->metadata.at("family"), "vae");
  const auto a = file->Floats("a", std::vector<int64_t>{2, 1});
  ASSERT_TRUE(a.ok()) << a.status();
  EXPECT_EQ(*a, (std::vector<float>{1, -2}));
  const auto step = file->Find("step");
  ASSERT_TRUE(step.ok());
  EXPECT_EQ((*step)->type, ElementType::kInt64);
  EXPECT_EQ((*step)->num_elements(), 1);
  EXPECT_EQ((*step)->bytes[0], 7);
}

TEST(TensorFileTest, EncodesWhatItReadsToTheSameBytesTwice) {
  TensorFile file;
  file.metadata["note"] = "\"quoted\"";
  file.tensors["w"] = TensorRecord::FromFloats({2, 3}, std::vector<float>{1, 2, 3, 4, 5, 6});
  file.tensors["empty"] = TensorRecord::FromFloats({0, 3}, {});
  const std::string bytes = EncodeTensors(file);
  const auto again = DecodeTensors(bytes, "weights");
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_EQ(EncodeTensors(*again), bytes);
  EXPECT_EQ(again->metadata, file.metadata);
  EXPECT_EQ(again->Floats("w", std::vector<int64_t>{2, 3}).value()[5], 6);
}

TEST(TensorFileTest, NamesTheTensorAndItsShapesWhenAnotherShapeIsWanted) {
  const auto file = DecodeTensors(HandMadeFile(), "weights");
  ASSERT_TRUE(file.ok());
  const auto wrong = file->Floats("a", std::vector<int64_t>{1, 2});
  EXPECT_EQ(ErrorReason(wrong.status()), "WRONG_SHAPE");
  EXPECT_EQ(Message(wrong.status()), "tensor 'a' is F32 (2, 1), expected F32 (1, 2)");
  EXPECT_EQ(ErrorReason(file->Floats("step", {}).status()), "WRONG_SHAPE");
  EXPECT_EQ(ErrorReason(file->Floats("b", {}).status()), "MISSING_TENSOR");
}

TEST(TensorFileTest, EveryCutOffFileIsRefused) {
  const std::string bytes = HandMadeFile();
  for (size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(DecodeTensors(bytes.substr(0, size), "weights").ok()) << size;
  }
  EXPECT_FALSE(DecodeTensors(bytes + " ", "weights").ok());
}

TEST(TensorFileTest, FilesWithSpoiltBytesAreReadOrRefusedButNeverCrash) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    std::string bytes = HandMadeFile();
    for (uint64_t n = 1 + random.Index(3); n > 0; --n) {
      bytes[random.Index(bytes.size())] = static_cast<char>(random.Index(256));
    }
    const auto file = DecodeTensors(bytes, "weights");
    if (file.ok()) {
      for (const auto& [name, record] : file->tensors) {
        EXPECT_EQ(record.num_elements() * ElementBytes(record.type), record.bytes.size());
      }
    }
  }
}

TEST(TensorFileTest, ShapesThatOverflowAreRefused) {
  std::string bytes = HandMadeFile();
  const size_t shape = bytes.find("[2,1]");
  const std::string huge = "[4294967296,4294967296,2]";
  bytes.replace(shape, 5, huge);
  bytes[0] = static_cast<char>(static_cast<unsigned char>(bytes[0]) + huge.size() - 5);
  const auto file = DecodeTensors(bytes, "weights");
  EXPECT_EQ(ErrorReason(file.status()), "MALFORMED_TENSORS") << file.status();
}

}  // namespace
}  // namespace poise::base
