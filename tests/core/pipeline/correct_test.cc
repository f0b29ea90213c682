#include "core/pipeline/correct.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <tuple>

#include "absl/time/clock.h"
#include "core/motion/io/clip_file.h"
#include "core/pipeline/correct_run.h"
#include "core/pipeline/correct_settings.h"
#include "tests/support/sanitizer.h"

namespace poise::pipeline {
namespace {

ResolvedSource Sample(const std::string& name) {
  motion::Clip clip =
      motion::ReadClipFile(std::string(POISE_SAMPLES_DIR) + "/" + name + ".bvh")->clip;
  auto roles = *motion::JointRoles::Detect(*clip.skeleton());
  return {std::move(clip), std::move(roles)};
}

api::CorrectSpec Spec(const std::string& method, int variants, int sources = 1) {
  api::CorrectSpec spec;
  for (int i = 0; i < sources; ++i) {
    spec.sources.push_back({.clip = api::StoredClip{}, .joint_roles = {}});
  }
  spec.method = method;
  spec.variants_per_source = variants;
  spec.effort = "instant";
  return spec;
}

std::unique_ptr<CorrectFlow> Flow(const api::CorrectSpec& spec, uint64_t seed = 7) {
  std::vector<ResolvedSource> sources;
  for (size_t i = 0; i < spec.sources.size(); ++i) {
    sources.push_back(Sample(i == 0 ? "kick" : "punch"));
  }
  auto flow = CorrectFlow::Create(spec, seed, std::move(sources));
  EXPECT_TRUE(flow.ok()) << flow.status();
  return *std::move(flow);
}

// What a run comes to: reports, and every bit of the clips.
struct Outcome {
  std::string reports;
  std::string clips;
  bool operator==(const Outcome&) const = default;
};

StatusOr<Outcome> RunAll(CorrectFlow& flow, CorrectRunConfig config = {},
                         const base::RunContext& context = {}) {
  CorrectRun run(flow, std::move(config), CorrectState::Empty(flow));
  POISE_RETURN_IF_ERROR(run.Run(context));
  Outcome outcome;
  for (int i = 0; i < flow.num_sources(); ++i) outcome.reports += api::ToJson(run.Report(i)).dump();
  for (const auto& variant : run.state().variants) {
    const auto rotations = variant->clip->rotations();
    outcome.clips.append(reinterpret_cast<const char*>(rotations.data()), rotations.size_bytes());
  }
  return outcome;
}

TEST(CorrectTest, ThreadsChangeNothing) {
  const auto flow = Flow(Spec("ik", 3, 2));
  const auto one = RunAll(*flow, {.threads = 1});
  const auto four = RunAll(*flow, {.threads = 4});
  ASSERT_TRUE(one.ok() && four.ok()) << one.status() << four.status();
  EXPECT_EQ(one->reports, four->reports);
  EXPECT_TRUE(one->clips == four->clips);
  const auto other = RunAll(*Flow(Spec("ik", 3, 2), /*seed=*/8));
  EXPECT_FALSE(one->clips == other->clips);
}

TEST(CorrectTest, TheMethodNoneCorrectsTheClipItself) {
  const auto flow = Flow(Spec("none", 0));
  ASSERT_EQ(flow->num_variants(), 1);
  const auto corrected = flow->Correct(0, {});
  ASSERT_TRUE(corrected.ok()) << corrected.status();
  const ResolvedSource kick = Sample("kick");
  EXPECT_TRUE(corrected->report.completed);
  EXPECT_EQ(corrected->clip->num_frames(), kick.clip.num_frames());
  EXPECT_TRUE(corrected->clip->skeleton()->SameAs(*kick.clip.skeleton()));
  EXPECT_EQ(corrected->samples, kick.clip.num_frames());
  EXPECT_EQ(corrected->curve.size(), 1u);
  EXPECT_GT(corrected->report.after->score.reward_normalised, 0.9);
}

TEST(CorrectTest, FastTriesAsOftenAsItIsTold) {
  api::CorrectSpec spec = Spec("none", 1);
  spec.effort = "fast";
  spec.overrides = {{"learning.rollouts", "4"}};
  const auto flow = Flow(spec);
  EXPECT_EQ(flow->samples_per_variant(0), 4 * flow->frames(0));
  const auto corrected = flow->Correct(0, {});
  ASSERT_TRUE(corrected.ok()) << corrected.status();
  EXPECT_EQ(corrected->curve.size(), 4u);
  EXPECT_EQ(corrected->samples, 4 * corrected->clip->num_frames());
  EXPECT_FALSE(corrected->timed_out);
}

TEST(CorrectTest, ResidualNoneLeavesTheBodyToItsLegs) {
  api::CorrectSpec spec = Spec("none", 1);
  spec.residual = "none";
  const auto corrected = Flow(spec)->Correct(0, {});
  ASSERT_TRUE(corrected.ok()) << corrected.status();
  EXPECT_EQ(corrected->report.after->score.residual_force_peak_bw, 0);
  EXPECT_EQ(corrected->report.after->score.residual_torque_peak_nm, 0);
}

TEST(CorrectTest, AFallIsReportedAndShownToTheEnd) {
  api::CorrectSpec spec = Spec("none", 1);
  spec.residual = "none";
  spec.overrides = {{"tracking.pelvis_stiffness", "0"}, {"tracking.pelvis_damping", "0"}};
  const auto corrected = Flow(spec)->Correct(0, {});
  ASSERT_TRUE(corrected.ok()) << corrected.status();
  EXPECT_FALSE(corrected->report.completed);
  ASSERT_TRUE(corrected->clip.has_value());
  EXPECT_LT(corrected->report.after->score.completion, 1);
  EXPECT_EQ(corrected->clip->num_frames(), Sample("kick").clip.num_frames());
}

TEST(CorrectTest, ADivergingSimulationIsAReportToo) {
  api::CorrectSpec spec = Spec("none", 1);
  // Legs that are asked for far more damping than a step can bear.
  spec.overrides = {{"tracking.pelvis_damping", "1e6"}, {"humanoid.torque_limit_factor", "100"}};
  const auto corrected = Flow(spec)->Correct(0, {});
  ASSERT_TRUE(corrected.ok()) << corrected.status();
  EXPECT_FALSE(corrected->report.completed);
  ASSERT_TRUE(corrected->report.error.has_value());
  EXPECT_EQ(corrected->report.error->reason, "DIVERGED");
  EXPECT_FALSE(corrected->clip.has_value());
  EXPECT_GT(corrected->report.before.jerk_rms_mps3, 0);
}

TEST(CorrectTest, TimeThatIsUpGivesTheBestSoFarOfEveryVariant) {
  api::CorrectSpec spec = Spec("ik", 4);
  spec.effort = "fast";
  spec.overrides = {{"learning.rollouts", "1000"}};
  const auto flow = Flow(spec);
  const double max_seconds = testing::kInstrumented ? 30 : 3;
  CorrectRun run(*flow, {.threads = 1, .max_seconds = max_seconds}, CorrectState::Empty(*flow));
  const absl::Time begin = absl::Now();
  ASSERT_TRUE(run.Run({}).ok());
  EXPECT_LT(absl::Now() - begin, absl::Seconds(max_seconds + 17))
      << "a thousand rollouts take minutes";
  const api::CorrectedClipReport report = run.Report(0);
  EXPECT_EQ(report.stopped_by, "max_seconds");
  ASSERT_EQ(report.variants.size(), 4u);
  for (const auto& variant : report.variants) EXPECT_TRUE(variant.after.has_value());
  ASSERT_GT(report.reward_curve.size(), 1u);
  EXPECT_EQ(report.reward_curve.back().samples, report.samples);
}

TEST(CorrectTest, WithoutAnyTimeEveryVariantSaysSo) {
  const auto flow = Flow(Spec("ik", 2));
  CorrectRun run(*flow, {.threads = 1, .max_seconds = 1e-9}, CorrectState::Empty(*flow));
  ASSERT_TRUE(run.Run({}).ok());
  const api::CorrectedClipReport report = run.Report(0);
  EXPECT_EQ(report.stopped_by, "max_seconds");
  EXPECT_FALSE(report.zero_policy.has_value());
  for (const auto& variant : report.variants) {
    ASSERT_TRUE(variant.error.has_value());
    EXPECT_EQ(variant.error->reason, "OUT_OF_TIME");
    EXPECT_FALSE(variant.completed);
  }
}

TEST(CorrectTest, TheJobsOwnDeadlineIsAnError) {
  const auto flow = Flow(Spec("ik", 2));
  base::RunContext context;
  context.deadline = absl::Now();
  EXPECT_TRUE(absl::IsDeadlineExceeded(RunAll(*flow, {.threads = 2}, context).status()));
}

TEST(CorrectTest, CancelledInTheMiddleItGoesOnWhereItWas) {
  api::CorrectSpec spec = Spec("ik", 4);
  spec.effort = "fast";
  spec.overrides = {{"learning.rollouts", "3"}};
  const auto flow = Flow(spec);
  const auto undisturbed = RunAll(*flow, {.threads = 2});
  ASSERT_TRUE(undisturbed.ok());
  base::RunContext context;
  CorrectState kept = CorrectState::Empty(*flow);
  int64_t kept_step = 0;
  CorrectRun first(*flow,
                   {.threads = 2,
                    .on_done =
                        [&](const CorrectState& state, int64_t step) {
                          kept = state;
                          kept_step = step;
                          if (step > 4 * flow->frames(0)) context.cancellation.Cancel();
                          return absl::OkStatus();
                        }},
                   CorrectState::Empty(*flow));
  EXPECT_TRUE(absl::IsCancelled(first.Run(context)));
  EXPECT_LT(kept_step, 13 * flow->frames(0));
  std::vector<base::Progress> progress;
  base::RunContext again;
  again.progress = [&](const base::Progress& value) { progress.push_back(value); };
  CorrectRun second(*flow, {.threads = 2}, kept);
  ASSERT_TRUE(second.Run(again).ok());
  EXPECT_EQ(progress.front().step, kept_step);
  EXPECT_EQ(progress.back().step, progress.back().total);
  EXPECT_GT(progress.back().metrics.at("samples"), 0);
  EXPECT_GT(progress.back().metrics.at("force"), 0);
  EXPECT_EQ(api::ToJson(second.Report(0)).dump(), undisturbed->reports);
}

TEST(CorrectTest, WithoutALearnerTheEffortFullIsRefused) {
  api::CorrectSpec spec = Spec("ik", 2);
  spec.effort = "full";
  std::vector<ResolvedSource> sources;
  sources.push_back(Sample("kick"));
  const Status status = CorrectFlow::Create(spec, 7, std::move(sources)).status();
  EXPECT_EQ(base::ErrorReason(status), "NO_NETWORKS") << status;
  EXPECT_EQ(base::ErrorField(status), "effort");
}

TEST(CorrectTest, TheResidualSaysWhoHoldsThePelvis) {
  api::CorrectSpec spec = Spec("ik", 2);
  spec.effort = "full";
  for (const auto& [residual, wrench, factor] :
       {std::tuple("pd", "pd_scaled", 2.0), std::tuple("none", "none", 0.0),
        std::tuple("rfc", "rfc", 0.0), std::tuple("pd_rfc", "pd_rfc", 2.0)}) {
    spec.residual = residual;
    const auto settings = CorrectSettings::From(spec);
    ASSERT_TRUE(settings.ok()) << settings.status();
    EXPECT_EQ(settings->imitation.residual, wrench);
    EXPECT_EQ(settings->correction.tracking.residual_factor, factor);
  }
}

TEST(CorrectTest, WhatCannotWorkIsRefusedWithItsField) {
  const auto field = [](api::CorrectSpec spec) {
    const Status status = CheckCorrect(spec);
    EXPECT_FALSE(status.ok());
    return base::ErrorReason(status) + " " + base::ErrorField(status);
  };
  api::CorrectSpec spec = Spec("ik", 2);
  EXPECT_TRUE(CheckCorrect(spec).ok());
  spec.overrides = {{"ik.radius_low", "0.95"}, {"humanoid.body_mass_kg", "60"}};
  EXPECT_TRUE(CheckCorrect(spec).ok());
  spec.overrides = {{"ik.radius_lo", "0.95"}};
  EXPECT_EQ(field(spec), "UNKNOWN_CONFIG_KEY ik.radius_lo");
  spec.overrides = {{"humanoid.mass", "60"}};
  EXPECT_EQ(field(spec), "UNKNOWN_CONFIG_KEY humanoid.mass");
  spec.overrides = {{"noise.sigma", "1"}};
  EXPECT_EQ(field(spec), "UNKNOWN_CONFIG_KEY noise.sigma") << "noise is not in the method";
  EXPECT_EQ(field(Spec("iq", 2)).substr(0, 14), "UNKNOWN_METHOD");
  spec = Spec("ik", 2);
  spec.overrides = {{"imitation.ppo.epoch", "2"}};
  EXPECT_EQ(field(spec), "UNKNOWN_CONFIG_KEY imitation.ppo.epoch");
}

}  // namespace
}  // namespace poise::pipeline
