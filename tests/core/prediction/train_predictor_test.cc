#include "core/prediction/training/train_predictor.h"

#include <gtest/gtest.h>

#include "core/motion/editing/cut.h"
#include "core/prediction/predictor_registry.h"
#include "tests/support/test_clips.h"

namespace poise::prediction {
namespace {

motion::BenchmarkClips Swings() {
  motion::BenchmarkClips clips;
  for (const uint64_t seed : {1, 1, 2}) {
    clips.train.push_back({"swing", "", testing::SwingingClip(150, 60, 0.3, seed)});
  }
  clips.counts.assign(3 * testing::Biped()->num_joints(), true);
  clips.variant = motion::EulerErrorVariant::kAllColumns;
  return clips;
}

PredictorTraining Small(int64_t steps) {
  PredictorTraining config;
  config.members = 1;
  config.validation_share = 0.1;
  config.mixer = {.past_frames = 10,
                  .future_frames = 8,
                  .width = 32,
                  .groups = 2,
                  .hidden = 48,
                  .blocks = 2,
                  .dropout = 0};
  config.trainer = {.steps = steps, .batch_size = 16, .validate_every = steps / 2};
  config.optimizer.learning_rate = 3e-3;
  config.mirror = config.speeds = false;
  return config;
}

StatusOr<PredictorResult> Train(const PredictorTraining& config, const base::RunContext& context) {
  return TrainPredictor({.clips = Swings(), .config = config}, context);
}

base::RunContext Seed(uint64_t seed) {
  base::RunContext context;
  context.seed = seed;
  return context;
}

double LastFrameError(const Predictor& predictor, const motion::Clip& clip) {
  double sum = 0;
  int count = 0;
  for (int start = 100; start + 18 <= clip.num_frames(); ++start) {
    const auto futures = predictor.Predict({{{*motion::Cut(clip, start, 10)}}}, 8, {});
    for (int joint = 1; joint < clip.num_joints(); ++joint, ++count) {
      sum += math::GeodesicDistance(futures->front().rotation(7, joint),
                                    clip.rotation(start + 17, joint));
    }
  }
  return sum / count;
}

TEST(TrainPredictorTest, BeatsHoldingStillOnWhatItHasSeen) {
  const auto trained = Train(Small(400), Seed(1));
  ASSERT_TRUE(trained.ok()) << trained.status();
  EXPECT_EQ(trained->model.card.steps, 400);
  EXPECT_GT(trained->model.card.scores.at("validation_rad"), 0);
  EXPECT_NE(trained->curve_csv.find("validation"), std::string::npos);
  const auto predictor = MakeTrainedPredictor(trained->model);
  ASSERT_TRUE(predictor.ok()) << predictor.status();
  const auto still = MakeTrainedPredictor(Train(Small(2), Seed(1))->model);
  const motion::Clip clip = testing::SwingingClip(150, 60);
  const double error = LastFrameError(**predictor, clip), held = LastFrameError(**still, clip);
  std::printf("last frame: %.4f rad, nearly untrained %.4f\n", error, held);
  EXPECT_LT(error, 0.5 * held);
}

TEST(TrainPredictorTest, TheCardSaysWhoseMotionWasLearned) {
  const auto trained = Train(Small(4), Seed(9));
  ASSERT_TRUE(trained.ok()) << trained.status();
  artifacts::ModelArtifact model = trained->model;
  EXPECT_EQ(model.card.family, "mixer");
  EXPECT_EQ(model.card.seed, 9u);
  EXPECT_EQ(model.card.signature.frame_rate, 60);
  EXPECT_GE(model.card.signature.roles.size(), 16u);
  const auto predictor = MakeTrainedPredictor(model);
  ASSERT_TRUE(predictor.ok()) << predictor.status();
  EXPECT_EQ((*predictor)->signature().past_frames, 10);
  EXPECT_EQ((*predictor)->signature().max_future_frames, 8);
  model.card.family = "vae";
  EXPECT_EQ(base::ErrorReason(MakeTrainedPredictor(model).status()), "WRONG_FAMILY");
  model.card.family = "mixer";
  model.card.normalisation = base::Json::object();
  EXPECT_EQ(base::ErrorReason(MakeTrainedPredictor(model).status()), "MALFORMED_CARD");
}

TEST(TrainPredictorTest, SameSeedGivesTheSameWeights) {
  const auto one = Train(Small(6), Seed(4));
  const auto two = Train(Small(6), Seed(4));
  const auto other = Train(Small(6), Seed(5));
  ASSERT_TRUE(one.ok()) << one.status();
  EXPECT_EQ(base::EncodeTensors(one->model.weights), base::EncodeTensors(two->model.weights));
  EXPECT_NE(base::EncodeTensors(one->model.weights), base::EncodeTensors(other->model.weights));
}

TEST(TrainPredictorTest, MembersOfAnEnsembleDifferAndTheirMeanIsTheAnswer) {
  PredictorTraining config = Small(40);
  config.members = 2;
  const auto trained = Train(config, Seed(1));
  ASSERT_TRUE(trained.ok()) << trained.status();
  const artifacts::ModelArtifact& model = trained->model;
  const auto ensemble = MakeTrainedPredictor(model);
  ASSERT_TRUE(ensemble.ok()) << ensemble.status();
  const Observation seen{*motion::Cut(testing::SwingingClip(150, 60), 20, 10)};
  std::vector<motion::Clip> alone;
  for (const char* prefix : {"member0.", "member1."}) {
    artifacts::ModelArtifact one{.card = model.card, .weights = {}};
    one.card.config["members"] = 1;
    for (const auto& [name, tensor] : model.weights.tensors) {
      if (name.starts_with(prefix)) one.weights.tensors[name.substr(8)] = tensor;
    }
    const auto member = MakeTrainedPredictor(one);
    ASSERT_TRUE(member.ok()) << member.status();
    alone.push_back((*member)->Predict({&seen, 1}, 8, {})->front());
  }
  const motion::Clip together = (*ensemble)->Predict({&seen, 1}, 8, {})->front();
  double apart = 0;
  for (int joint = 0; joint < together.num_joints(); ++joint) {
    const math::Quat& a = alone[0].rotation(7, joint);
    const math::Quat& b = alone[1].rotation(7, joint);
    EXPECT_LT(math::GeodesicDistance(together.rotation(7, joint), a.slerp(0.5, b)), 1e-7);
    apart = std::max(apart, math::GeodesicDistance(a, b));
  }
  EXPECT_GT(apart, 1e-3);
}

TEST(TrainPredictorTest, WrongSettingsAndCancellationAreErrors) {
  PredictorTraining config = Small(10);
  config.mixer.width = 0;
  EXPECT_EQ(base::ErrorReason(Train(config, {}).status()), "CONFIG_VALUE_OUT_OF_RANGE");
  config = Small(10);
  config.mixer.groups = 5;
  EXPECT_EQ(base::ErrorReason(Train(config, {}).status()), "CONFIG_VALUE_OUT_OF_RANGE");
  config = Small(10);
  config.mixer.past_frames = 500;
  EXPECT_EQ(base::ErrorReason(Train(config, {}).status()), "NO_WINDOWS");
  base::RunContext cancelled;
  cancelled.cancellation.Cancel();
  EXPECT_EQ(Train(Small(10), cancelled).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace poise::prediction
