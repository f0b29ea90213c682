#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/motion/io/clip_file.h"
#include "tests/core/motion/io/malformed_inputs.h"

namespace poise::motion {
namespace {

using testing::ExpectErrors;
using testing::Replace;

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

}  // namespace
}  // namespace poise::motion
