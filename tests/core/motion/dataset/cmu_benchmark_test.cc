// The published CMU protocol on the real files: lengths, constant columns, and the error of holding
// still in every action (reference sec. 1.9).
#include <gtest/gtest.h>

#include <map>

#include "core/motion/dataset/benchmark_clips.h"
#include "core/motion/dataset/windows.h"
#include "tests/support/data_files.h"

namespace poise::motion {
namespace {

// Mean error per output frame when the last observed pose is held, over the windows of a protocol.
std::vector<double> HoldingStill(const BenchmarkClips& clips, const LabelledClip& test,
                                 const EvaluationProtocol& protocol) {
  const PoseMatrix vectors = RotationVectors(test.clip, clips.sense);
  const auto starts = TestStarts(protocol, test.clip.num_frames());
  const WindowShape& shape = protocol.window;
  std::vector<double> mean(shape.future);
  for (const int start : *starts) {
    const PoseMatrix target = vectors.middleRows(start + shape.past, shape.future);
    const PoseMatrix held = vectors.row(start + shape.past - 1).replicate(shape.future, 1);
    const auto errors = EulerErrors(target, held, clips.counts, clips.variant);
    for (int frame = 0; frame < shape.future; ++frame) {
      mean[frame] += (*errors)[frame] / static_cast<double>(starts->size());
    }
  }
  return mean;
}

class CmuBenchmarkTest : public ::testing::Test {
 protected:
  void SetUp() override {
    POISE_REQUIRE_DATA("cmu");
    if (!clips_) {
      auto loaded = LoadCmuBenchmark(testing::DataPath("cmu"));
      ASSERT_TRUE(loaded.ok()) << loaded.status();
      clips_ = new BenchmarkClips(*std::move(loaded));
    }
  }

  static void ExpectTable(const char* protocol,
                          const std::map<std::string, std::vector<double>>& table) {
    const EvaluationProtocol rules = *FindProtocol(protocol);
    std::vector<double> mean(rules.frames.size());
    for (const LabelledClip& test : clips_->test) {
      const std::vector<double> errors = HoldingStill(*clips_, test, rules);
      for (size_t i = 0; i < rules.frames.size(); ++i) {
        EXPECT_NEAR(errors[rules.frames[i]], table.at(test.action)[i], 0.0015)
            << test.action << " frame " << rules.frames[i];
        mean[i] += errors[rules.frames[i]] / static_cast<double>(clips_->test.size());
      }
    }
    for (size_t i = 0; i < mean.size(); ++i) {
      EXPECT_NEAR(mean[i], table.at("mean")[i], 0.0015) << "mean frame " << rules.frames[i];
    }
  }

  static BenchmarkClips* clips_;
};

BenchmarkClips* CmuBenchmarkTest::clips_ = nullptr;

TEST_F(CmuBenchmarkTest, TestSequencesHaveThePublishedLengths) {
  const std::map<std::string, int> lengths = {{"basketball", 289}, {"jumping", 1043},
                                              {"running", 82},     {"soccer", 299},
                                              {"walking", 180},    {"washwindow", 1377}};
  ASSERT_EQ(clips_->test.size(), lengths.size());
  for (const LabelledClip& test : clips_->test) {
    EXPECT_EQ(test.clip.num_frames(), lengths.at(test.action)) << test.action;
    EXPECT_EQ(test.clip.frame_rate(), 60);
  }
}

// The published list names columns of 117; files of tips of bones, 7 nodes, are no joints here.
TEST_F(CmuBenchmarkTest, SixtyFourColumnsCountBesideTheRoot) {
  ASSERT_EQ(clips_->counts.size(), 93u);
  EXPECT_EQ(std::count(clips_->counts.begin(), clips_->counts.end(), true), 64 + 3);
}

TEST_F(CmuBenchmarkTest, HoldingStillHasThePublishedErrorOverSixtyFrames) {
  ExpectTable("seeded60", {{"basketball", {0.272, 0.459, 0.769, 1.059, 1.318, 1.533}},
                           {"jumping", {0.261, 0.357, 0.602, 0.864, 1.455, 1.651}},
                           {"running", {0.233, 0.435, 0.801, 1.121, 1.361, 1.523}},
                           {"soccer", {0.151, 0.271, 0.472, 0.707, 0.908, 1.074}},
                           {"walking", {0.317, 0.401, 0.575, 0.646, 0.758, 0.883}},
                           {"washwindow", {0.222, 0.318, 0.521, 0.670, 0.891, 1.077}},
                           {"mean", {0.242, 0.374, 0.623, 0.845, 1.115, 1.290}}});
}

TEST_F(CmuBenchmarkTest, HoldingStillHasThePublishedErrorOverSeventyFiveFrames) {
  ExpectTable("seeded75", {{"basketball", {0.459, 0.769, 1.318, 1.533, 1.884, 2.543}},
                           {"jumping", {0.357, 0.602, 1.455, 1.651, 1.954, 1.989}},
                           {"running", {0.534, 0.942, 1.342, 1.432, 1.554, 1.509}},
                           {"soccer", {0.271, 0.472, 0.908, 1.074, 1.316, 1.807}},
                           {"walking", {0.403, 0.596, 0.823, 0.942, 1.076, 1.324}},
                           {"washwindow", {0.337, 0.562, 0.887, 1.083, 1.294, 1.454}},
                           {"mean", {0.394, 0.657, 1.122, 1.286, 1.513, 1.771}}});
}

TEST(CmuBenchmarkErrorTest, MissingFolderIsNamed) {
  const Status status = LoadCmuBenchmark("/nowhere/cmu").status();
  EXPECT_EQ(base::ErrorReason(status), "FOLDER_NOT_FOUND");
  EXPECT_NE(base::Message(status).find("/nowhere/cmu"), std::string::npos);
}

}  // namespace
}  // namespace poise::motion
