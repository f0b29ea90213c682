#include "core/prediction/training/train_mixer.h"

#include <gtest/gtest.h>

#include "core/motion/editing/cut.h"
#include "core/prediction/mixer/mixer_predictor.h"
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

MixerTraining Small(int64_t steps) {
  MixerTraining config;
  config.mixer = {
      .past_frames = 10, .future_frames = 8, .width = 32, .hidden = 48, .blocks = 2, .dropout = 0};
  config.trainer = {.steps = steps, .batch_size = 16, .validate_every = steps / 2};
  config.optimizer.learning_rate = 3e-3;
  config.mirror = config.speeds = false;
  return config;
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

TEST(TrainMixerTest, BeatsHoldingStillOnWhatItHasSeen) {
  const auto trained = TrainMixer(Swings(), Small(400), Seed(1));
  ASSERT_TRUE(trained.ok()) << trained.status();
  EXPECT_EQ(trained->steps, 400);
  EXPECT_GT(trained->best_validation, 0);
  EXPECT_NE(trained->curve_csv.find("validation"), std::string::npos);
  const auto predictor = MixerPredictor::Create(Small(400).mixer, trained->body, trained->weights);
  ASSERT_TRUE(predictor.ok()) << predictor.status();
  const auto still = MixerPredictor::Create(Small(400).mixer, trained->body,
                                            TrainMixer(Swings(), Small(2), Seed(1))->weights);
  const motion::Clip clip = testing::SwingingClip(150, 60);
  const double error = LastFrameError(**predictor, clip), held = LastFrameError(**still, clip);
  std::printf("last frame: %.4f rad, nearly untrained %.4f\n", error, held);
  EXPECT_LT(error, 0.5 * held);
}

TEST(TrainMixerTest, SameSeedGivesTheSameWeights) {
  const auto one = TrainMixer(Swings(), Small(6), Seed(4));
  const auto two = TrainMixer(Swings(), Small(6), Seed(4));
  const auto other = TrainMixer(Swings(), Small(6), Seed(5));
  ASSERT_TRUE(one.ok()) << one.status();
  EXPECT_EQ(base::EncodeTensors(one->weights), base::EncodeTensors(two->weights));
  EXPECT_NE(base::EncodeTensors(one->weights), base::EncodeTensors(other->weights));
}

TEST(TrainMixerTest, WrongSettingsAndCancellationAreErrors) {
  MixerTraining config = Small(10);
  config.mixer.width = 0;
  EXPECT_EQ(base::ErrorReason(TrainMixer(Swings(), config, {}).status()),
            "CONFIG_VALUE_OUT_OF_RANGE");
  config = Small(10);
  config.mixer.past_frames = 500;
  EXPECT_EQ(base::ErrorReason(TrainMixer(Swings(), config, {}).status()), "NO_WINDOWS");
  base::RunContext cancelled;
  cancelled.cancellation.Cancel();
  EXPECT_EQ(TrainMixer(Swings(), Small(10), cancelled).status().code(),
            absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace poise::prediction
