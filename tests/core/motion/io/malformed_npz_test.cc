#include <gtest/gtest.h>

#include <limits>

#include "core/motion/io/clip_file.h"
#include "tests/core/motion/io/malformed_inputs.h"
#include "tests/core/motion/io/npz_bytes.h"

namespace poise::motion {
namespace {

using testing::Bytes;
using testing::ExpectErrors;
using testing::Npy;
using testing::Packing;
using testing::Zip;

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

}  // namespace
}  // namespace poise::motion
