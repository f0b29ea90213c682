#include <gtest/gtest.h>

#include "core/motion/io/clip_file.h"
#include "tests/core/motion/io/malformed_inputs.h"

namespace poise::motion {
namespace {

using testing::ExpectErrors;
using testing::Replace;

const std::string kAsf =
    ":units\n length 0.45\n angle deg\n:root\n order TX TY TZ RX RY RZ\n axis "
    "XYZ\n:bonedata\nbegin\n"
    "name thigh\ndirection 0 -1 0\nlength 7\naxis 0 0 20 XYZ\ndof rx rz\nend\nbegin\nname shank\n"
    "direction 0 -1 0\nlength 6\naxis 0 0 0 XYZ\ndof rx\nend\n:hierarchy\nbegin\nroot thigh\n"
    "thigh shank\nend\n";
const std::string kAmc = ":DEGREES\n1\nroot 0 0 0 0 0 0\nthigh 1 2\nshank 3\n";

TEST(MalformedTest, AmcErrorsNameTheLineAndTheExpectation) {
  ASSERT_TRUE(DecodeClip("a.amc", kAmc, ClipFormat::kAmc, {}, kAsf).ok());
  ExpectErrors(
      "a.amc", ClipFormat::kAmc,
      {
          {"empty", "", "MALFORMED_AMC", {"frame", "end of the file"}},
          {"unknown bone",
           Replace(kAmc, "shank", "shunk"),
           "MALFORMED_AMC",
           {"line 5", "'shunk'", "bone of the ASF"}},
          {"missing bone", Replace(kAmc, "shank 3\n", ""), "MALFORMED_AMC", {"frame 1", "'shank'"}},
          {"bone twice",
           Replace(kAmc, "shank", "thigh 1 2\nshank"),
           "MALFORMED_AMC",
           {"line 5", "twice"}},
          {"short line",
           Replace(kAmc, "thigh 1 2", "thigh 1"),
           "MALFORMED_AMC",
           {"line 4", "'thigh' has 1 numbers, expected 2"}},
          {"long line",
           Replace(kAmc, "thigh 1 2", "thigh 1 2 3"),
           "MALFORMED_AMC",
           {"line 4", "more than"}},
          {"NaN", Replace(kAmc, "thigh 1 2", "thigh 1 nan"), "MALFORMED_AMC", {"line 4", "'nan'"}},
          {"frame skipped", kAmc + "3\n", "MALFORMED_AMC", {"line 6", "frame number 2"}},
          {"huge frame number",
           kAmc + "99999999999999999999999\n",
           "MALFORMED_AMC",
           {"line 6", "frame number 2"}},
          {"bone before a frame", "thigh 1 2\n", "MALFORMED_AMC", {"line 1"}},
      },
      kAsf);
  const auto without = DecodeClip("a.amc", kAmc);
  EXPECT_EQ(base::ErrorReason(without.status()), "MISSING_SKELETON");
}

TEST(MalformedTest, AsfErrorsNameTheLineAndTheExpectation) {
  const auto expect = [](const std::string& asf, const std::string& reason,
                         const std::vector<std::string>& parts) {
    const auto result = DecodeClip("a.amc", kAmc, ClipFormat::kAmc, {}, asf);
    ASSERT_FALSE(result.ok()) << asf;
    const std::string message = base::Message(result.status());
    EXPECT_EQ(base::ErrorReason(result.status()), reason) << message;
    for (const std::string& part : parts) {
      EXPECT_NE(message.find(part), std::string::npos) << message;
    }
  };
  expect("garbage", "MALFORMED_ASF", {"':root'"});
  expect(Replace(kAsf, "root thigh\n", ""), "MALFORMED_ASF", {"'thigh' has no parent"});
  expect(Replace(kAsf, "root thigh", "shank thigh"), "MALFORMED_ASF", {"own ancestor"});
  expect(Replace(kAsf, "thigh shank\n", "thigh shank\nroot shank\n"), "MALFORMED_ASF",
         {"line 26", "second parent"});
  expect(Replace(kAsf, "thigh shank\n", "thigh shunk\n"), "MALFORMED_ASF", {"line 25", "'shunk'"});
  expect(Replace(kAsf, "thigh shank\n", "thigh root\n"), "MALFORMED_ASF", {"line 25", "'root'"});
  expect(Replace(kAsf, "name shank", "name thigh"), "DUPLICATE_JOINT", {"line 16", "'thigh'"});
  expect(Replace(kAsf, "name shank", "id 7"), "MALFORMED_ASF", {"line 21", "name"});
  expect(Replace(kAsf, "direction 0 -1 0", "direction 0 inf 0"), "MALFORMED_ASF",
         {"line 10", "direction y", "'inf'"});
  expect(Replace(kAsf, "length 0.45", "length 0"), "MALFORMED_ASF", {"line 2", "positive"});
  expect(Replace(kAsf, "axis 0 0 20 XYZ", "axis 0 0 20 XXZ"), "MALFORMED_ASF",
         {"line 12", "'XXZ'"});
  expect(Replace(kAsf, "dof rx rz", "dof rx rq"), "MALFORMED_ASF", {"line 13", "'rq'"});
  expect(Replace(kAsf, "angle deg", "angle turns"), "MALFORMED_ASF", {"line 3", "'turns'"});
  expect(kAsf.substr(0, kAsf.find("end")), "MALFORMED_ASF", {"'end'"});
}

TEST(MalformedTest, CmuTextErrorsNameTheLineAndTheExpectation) {
  std::string row = "0";
  for (int i = 1; i < 117; ++i) row += ",0";
  ASSERT_TRUE(DecodeClip("a.txt", row).ok());
  ExpectErrors("a.txt", ClipFormat::kCmuText,
               {
                   {"empty", "", "MALFORMED_CMU_TEXT", {"117 numbers"}},
                   {"short row",
                    row + "\n0,0\n",
                    "MALFORMED_CMU_TEXT",
                    {"line 2", "frame 1 has 2 numbers, expected 117"}},
                   {"long row", row + ",0", "MALFORMED_CMU_TEXT", {"line 1", "more than"}},
                   {"NaN",
                    row + "\n" + Replace(row, "0,0", "0,nan"),
                    "MALFORMED_CMU_TEXT",
                    {"line 2", "place 2 of frame 1", "'nan'"}},
                   {"empty field", Replace(row, "0,0", "0,,0"), "MALFORMED_CMU_TEXT", {"line 1"}},
                   {"words", "x,y,z", "MALFORMED_CMU_TEXT", {"line 1", "'x'"}},
               });
}

TEST(MalformedTest, DeepMimicErrorsNameTheFrameAndTheExpectation) {
  std::string frame = "[0.1,0,1,0";
  for (int i = 4; i < 44; ++i) {
    const bool is_w = i == 4 || i == 8 || i == 12 || i == 16 || i == 21 || i == 25 || i == 30 ||
                      i == 35 || i == 39;
    frame += is_w ? ",1" : ",0";
  }
  frame += "]";
  const auto file = [](const std::string& frames) { return "{\"Frames\": [" + frames + "]}"; };
  ASSERT_TRUE(DecodeClip("a.txt", file(frame + "," + frame)).ok());
  ExpectErrors("a.txt", ClipFormat::kDeepMimic,
               {
                   {"empty", "", "MALFORMED_DEEPMIMIC", {"byte", "JSON"}},
                   {"array", "[]", "MALFORMED_DEEPMIMIC", {"'Frames'"}},
                   {"no frames", "{}", "MALFORMED_DEEPMIMIC", {"'Frames'"}},
                   {"zero frames", file(""), "MALFORMED_DEEPMIMIC", {"at least one frame"}},
                   {"short frame",
                    file(frame + ",[1,2]"),
                    "MALFORMED_DEEPMIMIC",
                    {"frame 1 has 2 numbers, expected 44"}},
                   {"text", file("[\"x\"]"), "MALFORMED_DEEPMIMIC", {"frame 0", "found a text"}},
                   {"truncated", file(frame).substr(0, 60), "MALFORMED_DEEPMIMIC", {"byte"}},
                   {"overflow", file("[1e999]"), "MALFORMED_DEEPMIMIC", {"byte", "out of range"}},
                   {"deep nesting",
                    "{\"Frames\": " + std::string(100000, '['),
                    "MALFORMED_DEEPMIMIC",
                    {"found an array"}},
                   {"zero quaternion",
                    file(Replace(frame, "0,1,0,1,", "0,1,0,0,")),
                    "MALFORMED_DEEPMIMIC",
                    {"frame 0", "'pelvis'", "length 0"}},
                   {"negative duration",
                    file(Replace(frame, "[0.1", "[-0.1") + "," + frame),
                    "MALFORMED_DEEPMIMIC",
                    {"frame 0", "duration", "-0.1"}},
               });
}

TEST(MalformedTest, UnknownFilesAreRefusedWithTheFormatsThatAreKnown) {
  ExpectErrors("a.fbx", ClipFormat::kUnknown,
               {{"other format", "Kaydara", "UNKNOWN_FORMAT", {"'Kaydara'", "bvh", "npz"}}});
}

}  // namespace
}  // namespace poise::motion
