// Each malformed input gives one error that names the file, the line or entry, and what was
// expected.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/motion/io/clip_file.h"
#include "tests/core/motion/io/npz_bytes.h"

namespace poise::motion {
namespace {

using testing::Bytes;
using testing::Npy;
using testing::Packing;
using testing::Zip;

struct Malformed {
  std::string what;
  std::string data;
  std::string reason;
  std::vector<std::string> message;  // parts of it
};

void ExpectErrors(const std::string& file, ClipFormat format, const std::vector<Malformed>& table,
                  const std::string& skeleton = "") {
  for (const Malformed& entry : table) {
    const auto result = DecodeClip(file, entry.data, format, {}, skeleton);
    ASSERT_FALSE(result.ok()) << entry.what;
    const std::string message = base::Message(result.status());
    EXPECT_EQ(result.status().code(), absl::StatusCode::kInvalidArgument) << entry.what;
    EXPECT_EQ(base::ErrorReason(result.status()), entry.reason) << entry.what << ": " << message;
    EXPECT_EQ(message.rfind(file + ": ", 0), 0u) << entry.what << ": " << message;
    for (const std::string& part : entry.message) {
      EXPECT_NE(message.find(part), std::string::npos) << entry.what << ": " << message;
    }
  }
}

std::string Replace(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

const std::string kBvh =  // lines are counted in the table below
    "HIERARCHY\nROOT hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n"
    "JOINT left\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\n"
    "OFFSET 0 1 0\n}\n}\nJOINT right\n{\nOFFSET 0 1 0\nCHANNELS 3 Xposition Yposition "
    "Zposition\n}\n"
    "}\nMOTION\nFrames: 2\nFrame Time: 0.1\n0 0 0 1 2 3 0 1 0\n0 0 0 1 2 3 0 1 0\n";

TEST(MalformedTest, BvhErrorsNameTheLineAndTheExpectation) {
  ASSERT_TRUE(DecodeClip("a.bvh", kBvh).ok());
  std::string nested = "HIERARCHY\nROOT j";
  for (int i = 0; i < 100000; ++i) nested += fmt::format(" {{ OFFSET 0 0 0 JOINT j{}\n", i);
  std::string open = "HIERARCHY\nROOT j";
  for (int i = 0; i < 500; ++i) open += fmt::format("\n{{\nOFFSET 0 0 0\nJOINT j{}", i);
  ExpectErrors(
      "a.bvh", ClipFormat::kBvh,
      {
          {"empty", "", "MALFORMED_BVH", {"expected 'HIERARCHY'", "end of the file"}},
          {"binary",
           std::string("\x00\x01\xff", 3),
           "MALFORMED_BVH",
           {"line 1", "\\x00\\x01\\xff"}},
          {"no root",
           Replace(kBvh, "ROOT", "RUUT"),
           "MALFORMED_BVH",
           {"line 2", "'ROOT'", "'RUUT'"}},
          {"garbled keyword",
           Replace(kBvh, "OFFSET", "OFSET"),
           "MALFORMED_BVH",
           {"line 4", "'OFSET'"}},
          {"short offset",
           Replace(kBvh, "OFFSET 0 0 0", "OFFSET 0 0"),
           "MALFORMED_BVH",
           {"line 5", "OFFSET z"}},
          {"NaN offset",
           Replace(kBvh, "OFFSET 0 0 0", "OFFSET 0 nan 0"),
           "MALFORMED_BVH",
           {"line 4", "finite number for OFFSET y", "'nan'"}},
          {"unknown channel",
           Replace(kBvh, "Xrotation", "Wrotation"),
           "MALFORMED_BVH",
           {"line 9", "'Wrotation'", "Zrotation"}},
          {"too few channels",
           Replace(kBvh, "CHANNELS 3 Z", "CHANNELS 4 Z"),
           "MALFORMED_BVH",
           {"line 10", "channel 4 of 4"}},
          {"many channels",
           Replace(kBvh, "CHANNELS 3", "CHANNELS 999999999"),
           "MALFORMED_BVH",
           {"line 5", "0 to 12"}},
          {"negative channels",
           Replace(kBvh, "CHANNELS 3", "CHANNELS -3"),
           "MALFORMED_BVH",
           {"line 5"}},
          {"duplicate joint",
           Replace(kBvh, "JOINT right", "JOINT left"),
           "DUPLICATE_JOINT",
           {"line 15", "'left'"}},
          {"unnamed joint",
           Replace(kBvh, "JOINT right", "JOINT"),
           "MALFORMED_BVH",
           {"line 15", "name"}},
          {"no offset",
           Replace(kBvh, "OFFSET 0 1 0\nCHANNELS 3 Z", "CHANNELS 3 Z"),
           "MALFORMED_BVH",
           {"line 13", "'left'", "OFFSET"}},
          {"second root", Replace(kBvh, "MOTION", "ROOT b"), "MALFORMED_BVH", {"line 21", "ROOT"}},
          {"missing brace",
           Replace(kBvh, "}\nMOTION", "MOTION"),
           "MALFORMED_BVH",
           {"line 20", "'MOTION'", "'}'"}},
          {"surplus brace",
           Replace(kBvh, "}\nMOTION", "}\n}\nMOTION"),
           "MALFORMED_BVH",
           {"line 21", "'}'"}},
          {"deep nesting", nested, "TOO_LARGE", {"line 1025", "1024 joints"}},
          {"ends in the hierarchy", open, "MALFORMED_BVH", {"expected", "end of the file"}},
          {"no frames",
           Replace(kBvh, "Frames: 2", "Frames: 0"),
           "MALFORMED_BVH",
           {"line 22", "at least one"}},
          {"huge count",
           Replace(kBvh, "Frames: 2", "Frames: 999999999"),
           "MALFORMED_BVH",
           {"line 22", "999999999"}},
          {"large count",
           Replace(kBvh, "Frames: 2", "Frames: 9999999"),
           "TOO_LARGE",
           {"line 22", "9999999 frames"}},
          {"count beyond the file",
           Replace(kBvh, "Frames: 2", "Frames: 30000"),
           "MALFORMED_BVH",
           {"after 2 frames", "30000"}},
          {"count below the file",
           Replace(kBvh, "Frames: 2", "Frames: 1"),
           "MALFORMED_BVH",
           {"line 25", "end of the file after 1 frames"}},
          {"count is no number",
           Replace(kBvh, "Frames: 2", "Frames: two"),
           "MALFORMED_BVH",
           {"line 22", "'two'"}},
          {"zero frame time",
           Replace(kBvh, "Time: 0.1", "Time: 0"),
           "MALFORMED_BVH",
           {"line 23", "Frame Time"}},
          {"no frame time",
           Replace(kBvh, "Frame Time: 0.1\n", ""),
           "MALFORMED_BVH",
           {"line 23", "'Frame Time:'"}},
          {"short row",
           Replace(kBvh, "3 0 1 0\n0 0", "3 0 1\n0 0"),
           "MALFORMED_BVH",
           {"line 24", "frame 0 has 8 numbers, expected 9"}},
          {"long row",
           kBvh.substr(0, kBvh.size() - 1) + " 7\n",
           "MALFORMED_BVH",
           {"line 25", "frame 1 has more", "9", "'7'"}},
          {"NaN",
           Replace(kBvh, "0 0 0 1 2 3", "0 0 0 nan 2 3"),
           "MALFORMED_BVH",
           {"line 24", "place 4 of frame 0", "'nan'"}},
          {"infinity",
           Replace(kBvh, "0 0 0 1 2 3", "0 0 0 1e999 2 3"),
           "MALFORMED_BVH",
           {"line 24", "'1e999'"}},
          {"letters",
           Replace(kBvh, "0 0 0 1 2 3", "0 0 0 1x 2 3"),
           "MALFORMED_BVH",
           {"line 24", "'1x'"}},
          {"truncated in a row",
           kBvh.substr(0, kBvh.size() - 6),
           "MALFORMED_BVH",
           {"line 25", "frame 1 has 6 numbers"}},
          {"travelling joint",
           kBvh.substr(0, kBvh.size() - 4) + "2 0\n",
           "MOVING_JOINT_OFFSET",
           {"line 25", "frame 1", "'right'"}},
      });
}

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

TEST(MalformedTest, NpzErrorsNameTheEntryAndTheExpectation) {
  const std::string poses = Npy("<f8", "(1, 66)", std::string(66 * 8, '\0'));
  const std::string trans = Npy("<f8", "(1, 3)", std::string(3 * 8, '\0'));
  const std::string rate = Npy("<f8", "()", Bytes(std::vector<double>{60}));
  const auto with = [&](const std::string& p, const std::string& t, const std::string& r) {
    return Zip({{"poses.npy", p}, {"trans.npy", t}, {"mocap_framerate.npy", r}}, Packing::kStored);
  };
  const auto shaped = [&](const char* type, const char* shape, const std::string& data = "") {
    return with(Npy(type, shape, data), trans, rate);
  };
  ASSERT_TRUE(DecodeClip("a.npz", with(poses, trans, rate)).ok());
  const std::string good = with(poses, trans, rate);
  std::string damaged = good;
  damaged[good.find("NUMPY") + 300] ^= 1;
  std::vector<double> not_finite(66, 0.0);
  not_finite[5] = std::numeric_limits<double>::quiet_NaN();
  const std::string zeros(1 << 20, '\0');
  ExpectErrors(
      "a.npz", ClipFormat::kNpz,
      {
          {"empty", "", "MALFORMED_NPZ", {"'poses.npy'", "found none"}},
          {"no zip", "PK\x03\x04 garbage", "MALFORMED_NPZ", {"zip archive"}},
          {"truncated", good.substr(0, good.size() / 2), "MALFORMED_NPZ", {"zip archive"}},
          {"damaged", damaged, "MALFORMED_NPZ", {"poses.npy", "CRC"}},
          {"no poses",
           Zip({{"trans.npy", trans}}, Packing::kStored),
           "MALFORMED_NPZ",
           {"'poses.npy'", "found none"}},
          {"no trans",
           Zip({{"poses.npy", poses}}, Packing::kStored),
           "MALFORMED_NPZ",
           {"'trans.npy'"}},
          {"no rate",
           Zip({{"poses.npy", poses}, {"trans.npy", trans}}, Packing::kStored),
           "MALFORMED_NPZ",
           {"mocap_frame_rate"}},
          {"no array", with("garbage", trans, rate), "MALFORMED_NPZ", {"'poses.npy'", "NumPy"}},
          {"wrong columns",
           shaped("<f8", "(1, 65)", std::string(65 * 8, '\0')),
           "MALFORMED_NPZ",
           {"'poses.npy'", "66", "1, 65"}},
          {"wrong rank",
           shaped("<f8", "(66,)", std::string(66 * 8, '\0')),
           "MALFORMED_NPZ",
           {"'poses.npy'", "frames"}},
          {"no frames", shaped("<f8", "(0, 66)"), "MALFORMED_NPZ", {"'poses.npy'", "0, 66"}},
          {"other frames",
           with(poses, Npy("<f8", "(2, 3)", std::string(48, '\0')), rate),
           "MALFORMED_NPZ",
           {"'trans.npy'", "(1, 3)", "2, 3"}},
          {"huge shape", shaped("<f8", "(99999999999, 66)"), "TOO_LARGE", {"'poses.npy'"}},
          {"overflowing shape",
           shaped("<f8", "(9223372036854775807, 9223372036854775807)"),
           "TOO_LARGE",
           {"'poses.npy'"}},
          {"negative shape", shaped("<f8", "(-1, 66)"), "MALFORMED_NPZ", {"shape", "-1"}},
          {"short data",
           shaped("<f8", "(2, 66)", std::string(66 * 8, '\0')),
           "MALFORMED_NPZ",
           {"expected 132 numbers"}},
          {"big endian",
           shaped(">f8", "(1, 66)", std::string(66 * 8, '\0')),
           "MALFORMED_NPZ",
           {"little-endian", ">f8"}},
          {"objects", shaped("|O", "(1, 66)"), "MALFORMED_NPZ", {"little-endian"}},
          {"NaN",
           shaped("<f8", "(1, 66)", Bytes(not_finite)),
           "MALFORMED_NPZ",
           {"'poses.npy'", "nan", "place 5"}},
          {"version 9",
           with(Npy("<f8", "(1, 66)", "", 9), trans, rate),
           "MALFORMED_NPZ",
           {"version", "9"}},
          {"bad rate",
           with(poses, trans, Npy("<f8", "()", Bytes(std::vector<double>{-1}))),
           "MALFORMED_NPZ",
           {"'mocap_framerate.npy'", "positive"}},
      });
}

TEST(MalformedTest, AZipBombIsRefusedBeforeItUnfolds) {
  const std::string zeros(size_t{200} << 20, '\0');
  const std::string bomb = Zip({{"poses.npy", zeros}}, Packing::kDeflated);
  EXPECT_LT(bomb.size(), size_t{1} << 20);
  ExpectErrors("a.npz", ClipFormat::kNpz,
               {{"bomb", bomb, "TOO_LARGE", {"'poses.npy'", "209715200 bytes", "at most"}}});
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
