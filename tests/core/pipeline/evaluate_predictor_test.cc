#include "core/pipeline/evaluate_predictor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/prediction/predictor_registry.h"
#include "tests/support/data_files.h"
#include "tests/support/test_clips.h"

namespace poise::pipeline {
namespace {

using ::testing::HasSubstr;

motion::BenchmarkClips SmallBenchmark() {
  motion::BenchmarkClips clips;
  clips.variant = motion::EulerErrorVariant::kAllColumns;
  clips.counts.assign(3 * testing::Biped()->num_joints(), true);
  clips.train.push_back({"swing", "", testing::SwingingClip(80, 60)});
  clips.test.push_back({"swing", "", testing::SwingingClip(80, 60, 0.3, 2)});
  clips.test.push_back({"unseen", "", testing::SwingingClip(90, 60, 0.3, 3)});
  return clips;
}

TEST(EvaluatePredictorTest, ActionsWithoutTrainingClipsStayOutOfTheMean) {
  const auto scores = EvaluatePredictor(*prediction::FindBuiltInPredictor("zero-velocity"),
                                        SmallBenchmark(), *motion::FindProtocol("all"), {});
  ASSERT_TRUE(scores.ok()) << scores.status();
  ASSERT_EQ(scores->actions.size(), 2u);
  EXPECT_EQ(scores->actions[0].windows, 6);
  EXPECT_EQ(scores->actions[1].windows, 16);
  EXPECT_FALSE(scores->actions[1].trained_on);
  EXPECT_EQ(scores->mean, scores->actions[0].errors);
  EXPECT_GT(scores->mean[24], scores->mean[1]);
}

TEST(EvaluatePredictorTest, ResultsFileNamesEveryFrameThatTheProtocolShows) {
  const auto protocol = *motion::FindProtocol("all");
  const auto scores = EvaluatePredictor(*prediction::FindBuiltInPredictor("zero-velocity"),
                                        SmallBenchmark(), protocol, {});
  const std::string rows = ScoresCsvRows(*scores, {"zero-velocity@1", "", 3}, protocol, 60);
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 3 * 6);
  EXPECT_THAT(rows, HasSubstr("predict,zero-velocity@1,,all,swing,1,33.3,3,euler_mae,"));
  EXPECT_THAT(rows, HasSubstr("predict,zero-velocity@1,,all,mean,24,416.7,3,euler_mae,"));
}

// Sees further back than a protocol shows, or not far enough, or works on other data.
class Unfit : public prediction::Predictor {
 public:
  explicit Unfit(prediction::PredictorSignature signature) : signature_(std::move(signature)) {}
  const prediction::PredictorSignature& signature() const override { return signature_; }
  StatusOr<std::vector<motion::Clip>> Predict(std::span<const prediction::Observation>, int,
                                              const base::RunContext&) const override {
    return base::Internal("NEVER", "");
  }

 private:
  prediction::PredictorSignature signature_;
};

TEST(EvaluatePredictorTest, PredictorsThatDoNotFitAreRefused) {
  const auto reason = [](prediction::PredictorSignature signature) {
    return base::ErrorReason(EvaluatePredictor(Unfit(std::move(signature)), SmallBenchmark(),
                                               *motion::FindProtocol("all"), {})
                                 .status());
  };
  EXPECT_EQ(reason({.past_frames = 51}), "PAST_TOO_LONG");
  EXPECT_EQ(reason({.past_frames = 10, .max_future_frames = 1}), "HORIZON_TOO_SHORT");
  EXPECT_EQ(reason({.frame_rate = 30}), "WRONG_BENCHMARK");
}

// Reference sec. 1.9, the five actions that have training files.
TEST(EvaluatePredictorTest, FloorOnTheRealBenchmarkHasThePublishedMean) {
  POISE_REQUIRE_DATA("cmu");
  const auto clips = motion::LoadCmuBenchmark(testing::DataPath("cmu"));
  const auto scores = EvaluatePredictor(*prediction::FindBuiltInPredictor("zero-velocity"), *clips,
                                        *motion::FindProtocol("seeded75"), {});
  ASSERT_TRUE(scores.ok()) << scores.status();
  EXPECT_NEAR(scores->mean[1], (0.459 + 0.357 + 0.534 + 0.271 + 0.403) / 5, 0.0015);
  EXPECT_NEAR(scores->mean[9], (1.533 + 1.651 + 1.432 + 1.074 + 0.942) / 5, 0.0015);
}

}  // namespace
}  // namespace poise::pipeline
