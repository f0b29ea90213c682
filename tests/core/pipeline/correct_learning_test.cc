#include <gtest/gtest.h>

#include <string>

#include "core/motion/io/clip_file.h"
#include "core/pipeline/correct.h"
#include "core/pipeline/correct_run.h"
#include "core/pipeline/make_policy_learner.h"

// The correction flow with the effort full, which needs LibTorch.
namespace poise::pipeline {
namespace {

// A policy that learns for a moment only.
api::CorrectSpec LearningSpec() {
  api::CorrectSpec spec;
  spec.sources.push_back({.clip = api::StoredClip{}, .joint_roles = {}});
  spec.method = "ik";
  spec.variants_per_source = 2;
  spec.effort = "full";
  spec.overrides = {{"learning.rollouts", "2"},
                    {"imitation.held_out", "1"},
                    {"imitation.max_samples", "600"},
                    {"imitation.environments", "2"},
                    {"imitation.ppo.samples_per_update", "200"},
                    {"imitation.evaluate_every", "1"}};
  return spec;
}

std::unique_ptr<CorrectFlow> Flow() {
  motion::Clip clip = motion::ReadClipFile(std::string(POISE_SAMPLES_DIR) + "/kick.bvh")->clip;
  auto roles = *motion::JointRoles::Detect(*clip.skeleton());
  std::vector<ResolvedSource> sources;
  sources.push_back({std::move(clip), std::move(roles)});
  auto flow = CorrectFlow::Create(LearningSpec(), /*seed=*/7, std::move(sources),
                                  {.make_learner = MakePolicyLearner});
  EXPECT_TRUE(flow.ok()) << flow.status();
  return *std::move(flow);
}

TEST(CorrectLearningTest, FullLearnsAPolicyFirst) {
  const auto flow = Flow();
  CorrectRun run(*flow, {.threads = 2}, CorrectState::Empty(*flow));
  std::vector<base::Progress> progress;
  base::RunContext context;
  context.progress = [&](const base::Progress& value) { progress.push_back(value); };
  const Status status = run.Run(context);
  ASSERT_TRUE(status.ok()) << status;
  const api::CorrectedClipReport report = run.Report(0);
  EXPECT_EQ(report.stopped_by, "max_samples");
  EXPECT_GE(report.reward_curve.back().samples, 600);
  EXPECT_GT(report.samples, report.reward_curve.back().samples);
  ASSERT_EQ(report.variants.size(), 2u);
  for (const auto& variant : report.variants) {
    EXPECT_TRUE(variant.completed);
    EXPECT_TRUE(variant.effort == "fast" || variant.effort == "full") << variant.effort;
  }
  EXPECT_EQ(progress.back().step, progress.back().total);
  for (size_t i = 1; i < progress.size(); ++i) {
    EXPECT_GE(progress[i].metrics.at("samples"), progress[i - 1].metrics.at("samples") * 0.5);
  }
}

TEST(CorrectLearningTest, LearningThatWasCutOffEndsWithTheSamePolicy) {
  const auto calm = Flow();
  CorrectRun undisturbed(*calm, {.threads = 2}, CorrectState::Empty(*calm));
  ASSERT_TRUE(undisturbed.Run({}).ok());
  const auto flow = Flow();
  base::RunContext context;
  CorrectState kept = CorrectState::Empty(*flow);
  CorrectRun first(*flow,
                   {.threads = 2,
                    .on_done =
                        [&](const CorrectState& state, int64_t) {
                          kept = state;
                          context.cancellation.Cancel();
                          return absl::OkStatus();
                        }},
                   CorrectState::Empty(*flow));
  EXPECT_TRUE(absl::IsCancelled(first.Run(context)));
  ASSERT_FALSE(kept.policies[0].checkpoint.empty());
  ASSERT_FALSE(kept.policies[0].finished);
  const auto again = Flow();
  CorrectRun second(*again, {.threads = 1}, kept);
  ASSERT_TRUE(second.Run({}).ok());
  EXPECT_EQ(api::ToJson(second.Report(0)).dump(), api::ToJson(undisturbed.Report(0)).dump());
}

}  // namespace
}  // namespace poise::pipeline
