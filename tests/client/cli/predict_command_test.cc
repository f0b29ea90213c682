// `poise predict` against a real poised.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/motion/io/clip_file.h"
#include "tests/client/cli/poise_program.h"
#include "tests/support/test_clips.h"

namespace poise::testing {
namespace {

class PredictCommandTest : public ::testing::Test {
 protected:
  PredictCommandTest() {
    EXPECT_TRUE(motion::WriteBvhFile(Path("swing.bvh"), SwingingClip(5000)).ok());
  }
  std::string Path(const std::string& name) const { return server_.Path(name); }
  PoiseRun Predict(std::vector<std::string> more) const {
    more.insert(more.begin(), {"predict", Path("swing.bvh")});
    return server_.Poise(std::move(more));
  }

  PoiseServer server_{/*workers=*/0};
};

TEST_F(PredictCommandTest, WritesTheFutureAndSaysWhenItsFramesAre) {
  const PoiseRun run = Predict(
      {"--model", "constant-velocity", "--horizon", "0.1", "--out", Path("next.bvh"), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  const base::Json json = base::Json::parse(run.out);
  EXPECT_EQ(json["model"], "constant-velocity@1");
  EXPECT_EQ(json["frame_times_s"].size(), 12u);
  EXPECT_EQ(json["deterministic"], true);
  EXPECT_EQ(json["inpainted"], false);
  const auto future = motion::ReadClipFile(Path("next.bvh"));
  ASSERT_TRUE(future.ok()) << future.status();
  EXPECT_EQ(future->clip.num_frames(), 12);
  // A frame later, a steady motion is a little further.
  const motion::Clip past = SwingingClip(5000);
  EXPECT_LT((future->clip.root_position(0) - past.root_position(4999)).norm(), 0.05);
}

TEST_F(PredictCommandTest, ErrorsHaveTheExitCodeOfTheirKind) {
  const PoiseRun unknown = Predict({"--model", "oracle", "--json"});
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_EQ(base::Json::parse(unknown.out)["error"]["reason"], "UNKNOWN_MODEL");
  const PoiseRun far = Predict({"--horizon", "1000", "--json"});
  EXPECT_EQ(far.exit_code, 2);
  EXPECT_EQ(base::Json::parse(far.out)["error"]["field"], "horizon_s");
}

}  // namespace
}  // namespace poise::testing
