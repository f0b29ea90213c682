#include "core/synthesis/vae/vae_trainer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "core/motion/dataset/clip_folder.h"
#include "core/synthesis/vae/vae_model.h"
#include "core/synthesis/vae/vae_synthesizer.h"
#include "tests/support/data_files.h"
#include "tests/support/test_clips.h"

namespace poise::synthesis {
namespace {

// Small enough to learn in a second.
VaeConfig SmallConfig(int64_t steps) {
  VaeConfig config;
  config.net = {.latent = 4, .hidden = 32, .embedding = 32, .length_hidden = 8, .clock = 2};
  config.trainer.steps = steps;
  config.trainer.batch_size = 4;
  return config;
}

std::vector<motion::LabelledClip> SwingingClips() {
  std::vector<motion::LabelledClip> clips;
  for (int i = 0; i < 4; ++i) {
    clips.push_back({"swing", i < 3 ? "a" : "b", testing::SwingingClip(60 + 12 * i, 120, 0.3, i)});
  }
  return clips;
}

VaeTask SmallTask(int64_t steps) {
  VaeTask task;
  task.clips = SwingingClips();
  task.config = SmallConfig(steps);
  task.fold = {.action_class = "swing", .held_out = "b"};
  task.data = "swings";
  task.data_fingerprint = "abc";
  return task;
}

base::RunContext WithSeed(uint64_t seed) {
  base::RunContext context;
  context.seed = seed;
  return context;
}

TEST(VaeTrainerTest, OneKickIsReconstructedBelow005Rad) {
  POISE_REQUIRE_DATA("hdm05/kickLFront1Reps");
  auto kicks = motion::ReadClipFolder(testing::DataPath("hdm05"), {.action_class = "kick"});
  ASSERT_TRUE(kicks.ok()) << kicks.status();
  VaeTask task;
  task.clips = {kicks->clips.front()};
  task.config.net.hidden = 128;
  task.config.vae_optimizer.learning_rate = 3e-3;
  task.config.trainer.steps = 350;
  task.config.trainer.batch_size = 1;
  task.config.kl_weight = 0;
  task.config.adversarial = false;
  const auto result = TrainVae(task, WithSeed(1));
  ASSERT_TRUE(result.ok()) << result.status();
  const double error = result->model.card.scores.at("reconstruction_rad");
  std::printf("one kick, %lld steps: %.4f rad, %.4f m\n",
              static_cast<long long>(result->model.card.steps), error,
              result->model.card.scores.at("reconstruction_m"));
  EXPECT_LT(error, 0.05);
}

TEST(VaeTrainerTest, AnInterruptedRunEndsWithTheSameModel) {
  const auto whole = TrainVae(SmallTask(30), WithSeed(5));
  ASSERT_TRUE(whole.ok()) << whole.status();
  std::string checkpoint;
  base::RunContext context = WithSeed(5);
  const learning::CheckpointSink sink{.interval = absl::ZeroDuration(),
                                      .save = [&](std::string_view bytes, int64_t step) {
                                        checkpoint = bytes;
                                        if (step == 17) context.cancellation.Cancel();
                                        return absl::OkStatus();
                                      }};
  EXPECT_EQ(TrainVae(SmallTask(30), context, {}, sink).status().code(),
            absl::StatusCode::kCancelled);
  const auto resumed = TrainVae(SmallTask(30), WithSeed(5), checkpoint);
  ASSERT_TRUE(resumed.ok()) << resumed.status();
  EXPECT_EQ(artifacts::PackModel(resumed->model), artifacts::PackModel(whole->model));
  EXPECT_EQ(resumed->curve_csv, whole->curve_csv);
  const auto other = TrainVae(SmallTask(30), WithSeed(6));
  ASSERT_TRUE(other.ok());
  EXPECT_NE(artifacts::PackModel(other->model), artifacts::PackModel(whole->model));
}

TEST(VaeTrainerTest, TheCardTellsWhatWasLearnedAndFromWhom) {
  const auto result = TrainVae(SmallTask(5), WithSeed(1));
  ASSERT_TRUE(result.ok()) << result.status();
  const api::ModelCard& card = result->model.card;
  EXPECT_EQ(card.family, "vae");
  EXPECT_EQ(card.trained_on, "class swing, actors a, b held out");
  EXPECT_EQ(card.config["net.latent"], 4);
  EXPECT_EQ(card.signature.width(), 99);
  EXPECT_TRUE(card.scores.contains("held_out_reconstruction_rad"));
  EXPECT_EQ(card.weights_sha256, artifacts::WeightsDigest(result->model.weights));
  EXPECT_THAT(result->curve_csv, ::testing::HasSubstr("frame_discriminator.loss"));
  EXPECT_THAT(result->latent_map_svg, ::testing::HasSubstr("3 training motions"));
}

TEST(VaeTrainerTest, ClassesAndActorsThatAreNotThereAreRefusedWithWhatThereIs) {
  VaeTask task = SmallTask(5);
  task.fold = {.action_class = "kick"};
  EXPECT_THAT(base::Message(TrainVae(task, {}).status()), ::testing::HasSubstr("actions: swing"));
  task.fold = {.action_class = "swing", .held_out = "tr"};
  EXPECT_THAT(base::Message(TrainVae(task, {}).status()), ::testing::HasSubstr("actors: a, b"));
}

TEST(VaeTrainerTest, AGanMakesMotionsAsLongAsTheTrainingClips) {
  VaeTask task = SmallTask(300);
  task.config.generator = "gan";
  task.config.trainer.batch_size = 8;
  const auto result = TrainVae(task, WithSeed(1));
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_TRUE(result->model.card.scores.empty());
  const auto model = VaeModel::Create(result->model);
  ASSERT_TRUE(model.ok()) << model.status();
  const LatentSampler sampler = (*model)->MakeSampler({});
  base::Random random(3);
  int shortest = 1000, longest = 0;
  for (int i = 0; i < 50; ++i) {
    const auto clip = (*model)->Decode(sampler.Draw(random), "made");
    ASSERT_TRUE(clip.ok()) << clip.status();
    shortest = std::min(shortest, clip->num_frames());
    longest = std::max(longest, clip->num_frames());
  }
  // The training clips have 15, 18 and 21 frames.
  EXPECT_GE(shortest, 10);
  EXPECT_LT(shortest, longest);
  EXPECT_LE(longest, 21);
}

TEST(VaeTrainerTest, AGanWithoutAdversariesIsRefused) {
  VaeTask task = SmallTask(5);
  task.config.generator = "gan";
  task.config.adversarial = false;
  EXPECT_EQ(base::ErrorReason(TrainVae(task, {}).status()), "CONTRADICTING_SETTINGS");
}

TEST(VaeModelTest, SamplesAreClipsOfTheModelsBodyThatDependOnTheSeedAlone) {
  const auto result = TrainVae(SmallTask(200), WithSeed(1));
  ASSERT_TRUE(result.ok()) << result.status();
  const auto model = VaeModel::Create(result->model);
  ASSERT_TRUE(model.ok()) << model.status();
  const LatentSampler sampler = (*model)->MakeSampler({});
  base::Random a(7), b(7), c(8);
  const auto first = (*model)->Decode(sampler.Draw(a), "sample");
  ASSERT_TRUE(first.ok()) << first.status();
  EXPECT_EQ(first->frame_rate(), 30);
  EXPECT_EQ(first->num_joints(), 16);
  EXPECT_GT(first->num_frames(), 5);
  EXPECT_LE(first->num_frames(), 24);
  const auto same = (*model)->Decode(sampler.Draw(b), "sample");
  const auto other = (*model)->Decode(sampler.Draw(c), "sample");
  ASSERT_TRUE(same.ok() && other.ok());
  EXPECT_EQ(first->root_position(0), same->root_position(0));
  EXPECT_NE(first->root_position(0), other->root_position(0));
}

TEST(VaeModelTest, ModelsOfAnotherFamilyOrWithOtherWeightsAreRefused) {
  const auto result = TrainVae(SmallTask(2), WithSeed(1));
  ASSERT_TRUE(result.ok());
  artifacts::ModelArtifact model = result->model;
  model.card.family = "gcn";
  EXPECT_EQ(base::ErrorReason(VaeModel::Create(model).status()), "WRONG_FAMILY");
  model = result->model;
  model.card.config["net.hidden"] = 31;
  EXPECT_EQ(base::ErrorReason(VaeModel::Create(model).status()), "WRONG_SHAPE");
  model = result->model;
  model.weights.tensors.erase("latents/mean");
  EXPECT_EQ(base::ErrorReason(VaeModel::Create(model).status()), "MISSING_TENSOR");
  model = result->model;
  model.card.normalisation.erase("frames");
  EXPECT_EQ(base::ErrorReason(VaeModel::Create(model).status()), "MALFORMED_CARD");
}

TEST(VaeSynthesizerTest, VariantsAreDoneByTheSourcesBodyAtItsRate) {
  const auto result = TrainVae(SmallTask(200), WithSeed(1));
  ASSERT_TRUE(result.ok()) << result.status();
  const auto model = VaeModel::Create(result->model);
  ASSERT_TRUE(model.ok()) << model.status();
  const motion::Clip source = testing::SwingingClip(40, 120, 0.2, 9);
  const auto roles = motion::JointRoles::Detect(*source.skeleton());
  ASSERT_TRUE(roles.ok());
  const VaeSynthesizer synthesizer(*model, {});
  const Draft draft{.clip = source, .ik = {}};
  const auto bound = synthesizer.Bind(draft, *roles);
  ASSERT_TRUE(bound.ok()) << bound.status();
  base::Random random(3);
  const auto variant = (*bound)->Sample(random, {});
  ASSERT_TRUE(variant.ok()) << variant.status();
  EXPECT_TRUE(variant->clip.skeleton()->SameAs(*source.skeleton()));
  EXPECT_EQ(variant->clip.frame_rate(), 120);
  // It learned clips of 0.5 to 0.7 s.
  EXPECT_GT(variant->clip.duration(), 0.3);
  EXPECT_LT(variant->clip.duration(), 0.9);
}

}  // namespace
}  // namespace poise::synthesis
