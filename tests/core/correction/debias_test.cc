#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/correction/debias/debias_net.h"
#include "core/correction/debias/debias_trainer.h"
#include "core/correction/debias/debiaser.h"
#include "core/correction/debias/foot_hold.h"
#include "core/correction/debias/ridge.h"
#include "core/correction/preparation/foot_track.h"
#include "core/learning/nn/module_state.h"
#include "tests/core/correction/tracked_clip.h"

namespace poise::correction {
namespace {

constexpr int kElbow = 8;  // right forearm

// Two seconds that begin where the arms begin to sway.
motion::Clip Sway(const TrackedClip& tracked, double amplitude) {
  motion::Clip clip = tracked.reference.source_clip();
  for (int f = 0; f < clip.num_frames(); ++f) {
    for (int j = 1; j < clip.num_joints(); ++j) {
      clip.rotation(f, j) = Quat::Identity().slerp(amplitude, clip.rotation(f, j));
    }
  }
  return clip;
}

// What a body that lets its elbow hang, the more the farther the arm swings, makes of a motion.
motion::Clip WithHabit(motion::Clip clip) {
  for (int f = 0; f < clip.num_frames(); ++f) {
    const double swing = math::ToRotationVector(clip.rotation(f, kElbow - 1)).norm();
    const Quat hang = math::FromRotationVector(Vec3(0, 0.1 + 0.3 * swing, 0));
    clip.rotation(f, kElbow) = clip.rotation(f, kElbow) * hang;
    clip.root_position(f).x() += 0.02;
  }
  return clip;
}

DebiasPair Pair(const TrackedClip& tracked, double amplitude) {
  const motion::Clip original = Sway(tracked, amplitude);
  return {.imitated = WithHabit(original), .original = original, .body = tracked.model};
}

DebiasConfig SmallConfig(int64_t steps) {
  DebiasConfig config;
  config.input = {.moments = 1, .spacing_s = 0.05};
  config.layers = 1;
  config.hidden = 32;
  config.l2_weight = 0;
  config.mirror = false;  // the habit has a side
  config.hold.enabled = false;
  config.optimizer.learning_rate = 3e-3;
  config.trainer.steps = steps;
  config.trainer.batch_size = 64;
  return config;
}

base::RunContext WithSeed(uint64_t seed) {
  base::RunContext context;
  context.seed = seed;
  return context;
}

// A model as it is before training, or with weights that are as good as any.
artifacts::ModelArtifact Untrained(const DebiasConfig& config, DebiasNet& net) {
  artifacts::ModelArtifact model;
  model.card.family = Debiaser::kFamily;
  DebiasConfig copy = config;
  model.card.config = base::FieldsToJson(copy.Fields());
  EXPECT_TRUE(learning::AppendState(net, "", model.weights).ok());
  const int64_t inputs = InputWidth(config.input);
  const std::vector<float> zeros(inputs, 0), ones(inputs, 1);
  model.weights.tensors["input.mean"] = base::TensorRecord::FromFloats({inputs}, zeros);
  model.weights.tensors["input.scale"] = base::TensorRecord::FromFloats({inputs}, ones);
  model.weights.tensors["output.size"] = base::TensorRecord::FromFloats(
      {kCorrectionWidth}, std::vector<float>(kCorrectionWidth, 0.01f));
  return model;
}

void ExpectSame(const motion::Clip& a, const motion::Clip& b) {
  for (int f = 0; f < a.num_frames(); ++f) {
    ASSERT_EQ(a.root_position(f), b.root_position(f)) << f;
    for (int j = 0; j < a.num_joints(); ++j) {
      ASSERT_EQ(a.rotation(f, j).coeffs(), b.rotation(f, j).coeffs()) << f << " " << j;
    }
  }
}

// Moved on the ground and turned about the vertical.
motion::Clip Elsewhere(motion::Clip clip) {
  const Quat turn = math::FromRotationVector(Vec3(0, 2.1, 0));
  for (int f = 0; f < clip.num_frames(); ++f) {
    clip.root_position(f) = turn * clip.root_position(f) + Vec3(3, 0, -5);
    clip.rotation(f, 0) = turn * clip.rotation(f, 0);
  }
  return clip;
}

class DebiasTest : public ::testing::Test {
 protected:
  const TrackedClip tracked_ = Prepare(SwayingClip(3));
};

TEST_F(DebiasTest, TheCorrectionBetweenTwoMotionsTurnsOneIntoTheOther) {
  const DebiasPair pair = Pair(tracked_, 0.8);
  const motion::Clip back =
      ApplyCorrection(pair.imitated, CorrectionBetween(pair.imitated, pair.original));
  EXPECT_GT(ErrorBetween(pair.imitated, pair.original).joint_rad, 0.005);
  EXPECT_LT(ErrorBetween(back, pair.original).joint_rad, 1e-6);
  EXPECT_LT(ErrorBetween(back, pair.original).root_m, 1e-7);
}

TEST_F(DebiasTest, NeitherPlaceNorHeadingIsSeen) {
  const DebiasPair pair = Pair(tracked_, 0.8);
  const DebiasInput input;
  const FrameRows here = MakeFrameRows(pair.imitated, input);
  ASSERT_EQ(here.cols(), InputWidth(input));
  EXPECT_LT((MakeFrameRows(Elsewhere(pair.imitated), input) - here).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_LT((CorrectionBetween(Elsewhere(pair.imitated), Elsewhere(pair.original)) -
             CorrectionBetween(pair.imitated, pair.original))
                .cwiseAbs()
                .maxCoeff(),
            1e-5);
}

TEST_F(DebiasTest, BeforeTrainingNoBitChanges) {
  const DebiasConfig config;
  DebiasNet net(config);
  const auto debiaser = Debiaser::Create(Untrained(config, net));
  ASSERT_TRUE(debiaser.ok()) << debiaser.status();
  const motion::Clip imitated = Pair(tracked_, 1).imitated;
  const auto debiased = (*debiaser)->Apply(imitated, *tracked_.model);
  ASSERT_TRUE(debiased.ok()) << debiased.status();
  ExpectSame(*debiased, imitated);
}

TEST_F(DebiasTest, WithoutLibTorchTheNetworkSaysTheSame) {
  DebiasConfig config = SmallConfig(1);
  config.cutoff_hz = 0;
  torch::manual_seed(3);
  DebiasNet net(config);
  for (torch::Tensor& parameter : net.parameters()) torch::nn::init::normal_(parameter, 0, 0.1);
  const auto debiaser = Debiaser::Create(Untrained(config, net));
  ASSERT_TRUE(debiaser.ok()) << debiaser.status();
  const motion::Clip imitated = Pair(tracked_, 1).imitated;
  const motion::Clip debiased = *(*debiaser)->Apply(imitated, *tracked_.model);
  FrameRows rows = MakeFrameRows(imitated, config.input);
  net.eval();
  const torch::NoGradGuard no_gradient;
  const torch::Tensor said =
      0.01 * net.forward(torch::from_blob(rows.data(), {rows.rows(), rows.cols()}));
  FrameRows correction(rows.rows(), kCorrectionWidth);
  std::copy_n(said.contiguous().data_ptr<float>(), correction.size(), correction.data());
  const motion::Clip by_torch = ApplyCorrection(imitated, correction);
  EXPECT_GT(ErrorBetween(by_torch, imitated).joint_rad, 1e-3);
  EXPECT_LT(ErrorBetween(by_torch, debiased).joint_rad, 1e-5);
  EXPECT_LT(ErrorBetween(by_torch, debiased).root_m, 1e-6);
}

TEST_F(DebiasTest, AHabitIsUndoneOnAMotionThatWasNotLearnedFrom) {
  std::vector<DebiasPair> train;
  for (const double amplitude : {0.3, 0.6, 1.0}) train.push_back(Pair(tracked_, amplitude));
  const DebiasTask task{.train = {}, .held_out = {}, .config = SmallConfig(300)};
  const auto result = TrainDebias(task, train, {Pair(tracked_, 0.8)}, WithSeed(1));
  ASSERT_TRUE(result.ok()) << result.status();
  const auto& scores = result->model.card.scores;
  EXPECT_LT(scores.at("held_out_debiased_rad"), 0.3 * scores.at("held_out_imitated_rad"));
  EXPECT_LT(scores.at("held_out_debiased_m"), 0.3 * scores.at("held_out_imitated_m"));
  EXPECT_EQ(result->model.card.steps, 300);
  EXPECT_EQ(result->model.card.signature.frame_rate, 120);
}

TEST_F(DebiasTest, WhatActorsShareIsUndoneByTheLinearMap) {
  std::vector<DebiasPair> train;
  for (const double amplitude : {0.3, 0.6, 0.8, 1.0}) {
    train.push_back(Pair(tracked_, amplitude));
    train.back().actor = std::to_string(amplitude);
  }
  DebiasConfig config;
  config.mirror = false;  // the habit has a side
  config.hold.enabled = false;
  const DebiasTask task{.train = {}, .held_out = {}, .config = config};
  const auto result = TrainDebias(task, train, {Pair(tracked_, 0.7)}, {});
  ASSERT_TRUE(result.ok()) << result.status();
  const auto& scores = result->model.card.scores;
  EXPECT_LT(scores.at("held_out_debiased_rad"), 0.3 * scores.at("held_out_imitated_rad"));
  EXPECT_LT(scores.at("left_out_debiased_rad"), 0.6 * scores.at("left_out_imitated_rad"));
}

TEST_F(DebiasTest, WhatHelpsNobodyWhoIsLeftOutChangesNothing) {
  std::vector<DebiasPair> train;
  // Each actor's elbow hangs another way.
  for (const double way : {-0.2, 0.2}) {
    DebiasPair pair = Pair(tracked_, 1);
    pair.imitated = pair.original;
    for (int f = 0; f < pair.imitated.num_frames(); ++f) {
      pair.original.rotation(f, kElbow) = math::FromRotationVector(Vec3(0, way, 0));
      pair.imitated.rotation(f, kElbow) = Quat::Identity();
    }
    pair.actor = std::to_string(way);
    train.push_back(std::move(pair));
  }
  DebiasConfig config;
  config.mirror = false;
  const DebiasTask task{.train = {}, .held_out = {}, .config = config};
  const auto result = TrainDebias(task, train, {}, {});
  ASSERT_TRUE(result.ok()) << result.status();
  const auto& scores = result->model.card.scores;
  EXPECT_GT(scores.at("left_out_debiased_rad"), scores.at("left_out_imitated_rad"));
  EXPECT_EQ(scores.at("debiased_rad"), scores.at("imitated_rad"));
}

TEST(RidgeTest, IsTheLeastPenalisedSumOfSquares) {
  // One input: weight = cov(x, y) / (var(x) + l2), by hand.
  ActorFrames actor{FrameRows(4, 1), FrameRows::Zero(4, kCorrectionWidth)};
  actor.inputs << -1, 0, 1, 2;
  actor.corrections.col(7) << 1, 2, 4, 5;
  const RidgeFit fit = FitRidge({actor}, 0.75);
  EXPECT_NEAR(fit.weight(0, 7), 1.75 / (1.25 + 0.75), 1e-9);
  EXPECT_NEAR(fit.bias(7), 3 - 0.5 * fit.weight(0, 7), 1e-9);
  EXPECT_EQ(fit.weight(0, 8), 0);
}

TEST(RidgeTest, EachJointGetsWhatHelpsActorsWhoAreLeftOut) {
  base::Random random(3);
  std::vector<ActorFrames> actors;
  for (int a = 0; a < 4; ++a) {
    ActorFrames actor{FrameRows(200, 3), FrameRows(200, kCorrectionWidth)};
    for (float& x : actor.inputs.reshaped()) x = static_cast<float>(random.Normal());
    actor.corrections.setZero();
    // Joint 2 follows the first input in all of them, joint 5 in each another way.
    actor.corrections.col(3 + 6 * 2) = 0.5F * actor.inputs.col(0);
    actor.corrections.col(3 + 6 * 5) = (a % 2 == 0 ? 0.5F : -0.5F) * actor.inputs.col(0);
    actors.push_back(std::move(actor));
  }
  const RidgeFit fit = FitRidgeByActors(actors);
  EXPECT_GT(fit.weight(0, 3 + 6 * 2), 0.45);
  EXPECT_EQ(fit.weight.col(3 + 6 * 5).norm(), 0);
  ASSERT_EQ(fit.left_out_errors.size(), kL2Candidates.size());
  EXPECT_GT(fit.left_out_uncorrected, 0);
}

TEST_F(DebiasTest, AnInterruptedTrainingEndsWithTheSameModel) {
  const std::vector<DebiasPair> train = {Pair(tracked_, 0.5), Pair(tracked_, 1)};
  const DebiasTask task{.train = {}, .held_out = {}, .config = SmallConfig(30)};
  const auto whole = TrainDebias(task, train, {}, WithSeed(5));
  ASSERT_TRUE(whole.ok()) << whole.status();
  std::string checkpoint;
  base::RunContext context = WithSeed(5);
  const learning::CheckpointSink sink{.interval = absl::ZeroDuration(),
                                      .save = [&](std::string_view bytes, int64_t step) {
                                        checkpoint = bytes;
                                        if (step == 11) context.cancellation.Cancel();
                                        return absl::OkStatus();
                                      }};
  EXPECT_TRUE(absl::IsCancelled(TrainDebias(task, train, {}, context, {}, sink).status()));
  const auto resumed = TrainDebias(task, train, {}, WithSeed(5), checkpoint);
  ASSERT_TRUE(resumed.ok()) << resumed.status();
  EXPECT_TRUE(artifacts::PackModel(resumed->model) == artifacts::PackModel(whole->model));
}

TEST_F(DebiasTest, TheCharactersOwnHabitsAreLearnedFromClips) {
  const DebiasTask task{
      .train = {{SwayingClip(2)}}, .held_out = {{SwayingClip(1.5)}}, .config = SmallConfig(100)};
  const auto result = TrainDebias(task, WithSeed(1));
  ASSERT_TRUE(result.ok()) << result.status();
  const auto& scores = result->model.card.scores;
  EXPECT_LT(scores.at("debiased_rad"), scores.at("imitated_rad"));
  EXPECT_GT(scores.at("held_out_imitated_rad"), 0);
}

TEST_F(DebiasTest, FeetThatStandStayWhereTheyWereImitated) {
  const motion::Clip& imitated = tracked_.reference.source_clip();
  motion::Clip debiased = imitated;
  for (int f = 0; f < debiased.num_frames(); ++f) {
    debiased.root_position(f) += Vec3(0.02, -0.03, 0.01);
    debiased.rotation(f, 1) = math::FromRotationVector(Vec3(0.1, 0, 0));
  }
  const motion::Clip held = HoldFeet(debiased, imitated, *tracked_.model, {});
  const auto was = TrackFeet(imitated, *tracked_.model), is = TrackFeet(held, *tracked_.model);
  for (int side = 0; side < 2; ++side) {
    for (int f = 0; f < held.num_frames(); f += 20) {
      EXPECT_LT((was[side].ankles[f] - is[side].ankles[f]).norm(), 1e-6) << side << " " << f;
      EXPECT_LT(math::GeodesicDistance(was[side].rotations[f], is[side].rotations[f]), 1e-6);
    }
  }
  // The pelvis sinks a little, so that straight legs reach.
  EXPECT_LT((held.root_position(30) - imitated.root_position(30)).norm(), 2e-3);
  EXPECT_LT(math::GeodesicDistance(held.rotation(30, 1), debiased.rotation(30, 1)), 1e-9);
}

TEST_F(DebiasTest, RefusesWhatDoesNotFit) {
  artifacts::ModelArtifact other;
  other.card.family = "vae";
  EXPECT_EQ(base::ErrorReason(Debiaser::Create(other).status()), "WRONG_FAMILY");
  DebiasNet net{SmallConfig(1)};
  artifacts::ModelArtifact cut = Untrained(SmallConfig(1), net);
  cut.weights.tensors.erase("layer1.bias");
  EXPECT_EQ(base::ErrorReason(Debiaser::Create(cut).status()), "MISSING_TENSOR");
  const DebiasTask task{.train = {}, .held_out = {}, .config = SmallConfig(1)};
  EXPECT_EQ(base::ErrorReason(TrainDebias(task, {}, {}, WithSeed(1)).status()), "NOTHING_IMITATED");
  DebiasConfig config;
  config.dropout = 1;
  EXPECT_EQ(base::ErrorField(config.Validate()), "dropout");
  config.dropout = 0.1;
  EXPECT_EQ(base::ErrorReason(config.Validate()), "CONTRADICTING_SETTINGS");
  EXPECT_EQ(base::ErrorReason(DebiasConfig::FromPreset("best").status()), "UNKNOWN_PRESET");
  EXPECT_TRUE(DebiasConfig::FromPreset("paper")->Validate().ok());
}

}  // namespace
}  // namespace poise::correction
