#include "core/correction/imitation/imitation_learner.h"

#include <gtest/gtest.h>

#include "core/correction/imitation/policy_rollout.h"
#include "core/motion/io/clip_file.h"
#include "core/synthesis/synthesizer_registry.h"
#include "tests/core/correction/tracked_clip.h"
#include "tests/support/data_files.h"

namespace poise::correction {
namespace {

motion::JointRoles RolesOf(const motion::Clip& clip) {
  return *motion::JointRoles::Detect(*clip.skeleton());
}

// Variants that lean differently, so that the residual has to hold them.
StatusOr<motion::Clip> Leaning(uint64_t draw) {
  motion::Clip clip = SwayingClip(1);
  const double angle = 0.05 + 0.0002 * static_cast<double>(draw % 500);
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    clip.rotation(frame, 0) = math::FromRotationVector(Vec3(angle, 0, 0));
  }
  return clip;
}

Corrector MakeCorrector() {
  const motion::Clip clip = SwayingClip(1);
  CorrectionConfig config;
  config.learning.rollouts = 4;
  return std::move(Corrector::Create(clip, RolesOf(clip), config)).value();
}

// A few hundred samples of a small network.
ImitationConfig Small() {
  ImitationConfig config;
  config.max_samples = 1200;
  config.max_seconds = 1000;
  config.evaluate_every = 1;
  config.held_out = 2;
  config.environments = 3;
  config.ppo.samples_per_update = 192;
  config.ppo.warmup_samples = 96;
  config.ppo.minibatch = 64;
  config.ppo.threads = 1;
  config.ppo.actor.hidden_layers = "16";
  config.ppo.critic.hidden_layers = "16";
  return config;
}

ImitationLearner MakeLearner(const ImitationConfig& config = Small(), uint64_t seed = 3) {
  return std::move(ImitationLearner::Create(MakeCorrector(), Leaning, config, seed)).value();
}

// What is equal of two trainings; seconds are not.
void ExpectSame(const TrainingReport& a, const TrainingReport& b) {
  ASSERT_EQ(a.curve.size(), b.curve.size());
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(a.best, b.best);
  for (size_t i = 0; i < a.curve.size(); ++i) {
    EXPECT_EQ(a.curve[i].samples, b.curve[i].samples);
    EXPECT_EQ(a.curve[i].merit, b.curve[i].merit);
    EXPECT_EQ(a.curve[i].reward_normalised, b.curve[i].reward_normalised);
  }
}

TEST(ImitationLearnerTest, TheSameSeedGivesTheSamePolicyOnAnyNumberOfThreads) {
  ImitationLearner one = MakeLearner();
  const TrainingReport report = *one.Train();
  EXPECT_GE(report.samples, 1200);
  EXPECT_GT(report.curve.size(), 4u);
  EXPECT_NE(report.curve.back().merit, report.curve.front().merit);
  ImitationConfig config = Small();
  config.ppo.threads = 2;
  ExpectSame(report, *MakeLearner(config).Train());
  EXPECT_NE(MakeLearner(Small(), 4).Train()->curve.back().merit, report.curve.back().merit);
}

TEST(ImitationLearnerTest, AStoppedTrainingGoesOnAsIfItHadNotStopped) {
  std::vector<std::string> checkpoints;
  ImitationLearner whole = MakeLearner();
  const TrainingReport report = *whole.Train({}, [&](std::string bytes) {
    checkpoints.push_back(std::move(bytes));
    return absl::OkStatus();
  });
  ASSERT_GT(checkpoints.size(), 3u);
  for (const size_t at : {size_t{0}, checkpoints.size() / 2, checkpoints.size() - 1}) {
    ImitationLearner resumed = MakeLearner();
    ASSERT_TRUE(resumed.Restore(checkpoints[at]).ok());
    ExpectSame(report, *resumed.Train());
    const motion::Clip variant = *Leaning(77);
    EXPECT_EQ(resumed.Correct(variant)->score.reward_total,
              whole.Correct(variant)->score.reward_total);
  }
}

TEST(ImitationLearnerTest, AnErrorOfTheCheckpointsReceiverEndsTraining) {
  ImitationLearner learner = MakeLearner();
  const auto full = [](const std::string&) {
    return base::ResourceExhausted("DISK_FULL", "", "no space");
  };
  EXPECT_EQ(base::ErrorReason(learner.Train({}, full).status()), "DISK_FULL");
}

TEST(ImitationLearnerTest, AtTheDeadlineTheBestSoFarCounts) {
  ImitationConfig config = Small();
  config.max_samples = 1'000'000;
  ImitationLearner learner = MakeLearner(config);
  base::RunContext context;
  int64_t samples = 0;
  context.progress = [&](const base::Progress& progress) { samples = progress.step; };
  context.deadline = absl::Now() + absl::Milliseconds(300);
  const TrainingReport report = *learner.Train(context);
  EXPECT_TRUE(report.timed_out);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.samples, samples);
  for (size_t i = 1; i < report.curve.size(); ++i) {
    EXPECT_LE(report.curve[i].merit, report.curve[report.best].merit);
  }
  EXPECT_TRUE(learner.Correct(*Leaning(5))->score.completed);
}

TEST(ImitationLearnerTest, KeepsAPolicyThatLearnedEvenWhereNoneIsBetterThanBefore) {
  ImitationConfig config = Small();
  config.ppo.actor.learning_rate = 1;  // ruins it
  config.ppo.kl_limit = 0;
  ImitationLearner learner = MakeLearner(config);
  const TrainingReport report = *learner.Train();
  ASSERT_GT(report.curve.size(), 1u);
  EXPECT_LT(report.curve[report.best].merit, report.curve.front().merit);
  EXPECT_GT(report.best, 0);
  EXPECT_TRUE(learner.Correct(*Leaning(5))->score.completed) << "fast was a candidate";
}

TEST(ImitationLearnerTest, ItsOwnLimitOfTimeIsNoTimeout) {
  ImitationConfig config = Small();
  config.max_samples = 1'000'000;
  config.max_seconds = 0.2;
  ImitationLearner learner = MakeLearner(config);
  const TrainingReport report = *learner.Train();
  EXPECT_FALSE(report.timed_out);
  EXPECT_LT(report.samples, 1'000'000);
}

TEST(ImitationLearnerTest, TrainingEndsWhereNothingIsGained) {
  ImitationConfig config = Small();
  config.max_samples = 1'000'000;
  config.patience = 3;
  config.least_gain = 1;  // nothing gains so much
  ImitationLearner learner = MakeLearner(config);
  const TrainingReport report = *learner.Train();
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.curve.size(), 4u);
}

TEST(ImitationLearnerTest, ACancelledTrainingSaysSo) {
  ImitationLearner learner = MakeLearner();
  base::RunContext context;
  context.progress = [&](const base::Progress&) { context.cancellation.Cancel(); };
  EXPECT_EQ(learner.Train(context).status().code(), absl::StatusCode::kCancelled);
}

TEST(ImitationLearnerTest, NoCorrectionIsWorseThanThatOfFast) {
  ImitationLearner learner = MakeLearner();  // hardly trained
  ASSERT_TRUE(learner.Train().ok());
  const Corrector corrector = MakeCorrector();
  for (const uint64_t draw : {11, 222, 333}) {
    const motion::Clip variant = *Leaning(draw);
    const Correction fast = *corrector.Correct(variant), full = *learner.Correct(variant);
    EXPECT_GE(Merit(full.score, Small()), Merit(fast.score, Small()));
    EXPECT_TRUE(full.effort == "full" || full.effort == "fast");
    if (full.effort == "full") continue;
    EXPECT_EQ(full.score.reward_total, fast.score.reward_total);
  }
}

TEST(ImitationLearnerTest, RefusesCheckpointsThatAreNotItsOwn) {
  ImitationLearner learner = MakeLearner();
  const std::string checkpoint = learner.Save();
  EXPECT_EQ(base::ErrorReason(MakeLearner(Small(), 4).Restore(checkpoint)), "CHECKPOINT_DIFFERS");
  EXPECT_EQ(base::ErrorReason(learner.Restore("nonsense")), "MALFORMED_CHECKPOINT");
  EXPECT_EQ(base::ErrorReason(learner.Restore(checkpoint.substr(0, checkpoint.size() / 2))),
            "MALFORMED_CHECKPOINT");
  EXPECT_TRUE(learner.Restore(checkpoint).ok());
}

TEST(ImitationLearnerTest, AFewSecondsOfLearningLowerTheForceOnUnseenVariants) {
  const std::string file = "hdm05/depositFloorR/HDM_bd_depositFloorR_001_120.amc";
  POISE_REQUIRE_DATA(file);
  const motion::Clip clip = motion::ReadClipFile(testing::DataPath(file))->clip;
  const motion::JointRoles roles = RolesOf(clip);
  const auto steps = *synthesis::CreateMethod("ik", {.action_class = "deposit"});
  const synthesis::Draft source{clip, std::nullopt};
  const auto bound = *steps.front().synthesizer->Bind(source, roles);
  // As the clip came: prepared, it leaves too little force to learn away within seconds.
  CorrectionConfig unprepared;
  unprepared.reference.preparation.enabled = false;
  unprepared.reference.floor = "lowest";
  const Corrector corrector = *Corrector::Create(clip, roles, unprepared);
  ImitationConfig config;
  config.max_samples = 20'000;
  config.max_seconds = 1000;
  ImitationLearner learner = std::move(*ImitationLearner::Create(
      corrector,
      [&](uint64_t draw) -> StatusOr<motion::Clip> {
        base::Random random(draw);
        POISE_ASSIGN_OR_RETURN(synthesis::Draft draft, bound->Sample(random, {}));
        return std::move(draft.clip);
      },
      config, 1));
  const TrainingReport report = *learner.Train();
  const PolicyScore &before = report.curve.front(), &best = report.curve[report.best];
  EXPECT_GE(best.completed, before.completed);
  EXPECT_GT(best.merit, before.merit + 0.03);
  EXPECT_LT(best.residual_force_mean_bw, 0.6 * before.residual_force_mean_bw);
}

}  // namespace
}  // namespace poise::correction
