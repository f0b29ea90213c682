#include <gtest/gtest.h>

#include <algorithm>

#include "core/motion/metrics/plausibility.h"
#include "core/synthesis/synthesizer_registry.h"
#include "samples/author/samples.h"

namespace poise::samples {
namespace {

using motion::JointRole;
using motion::JointRoles;
using synthesis::Draft;

constexpr int kVariants = 40;

// Variants of a sample by IK, with the action class of the sample's own name.
std::vector<Draft> Augment(const Performance& script) {
  const Draft source{*Perform(script), std::nullopt};
  const auto method = synthesis::CreateMethod("ik", {.action_class = script.name});
  const auto bound =
      method->front().synthesizer->Bind(source, *JointRoles::Detect(*source.clip.skeleton()));
  EXPECT_TRUE(bound.ok()) << base::Message(bound.status());
  std::vector<Draft> drafts;
  for (int seed = 0; seed < kVariants; ++seed) {
    base::Random random(seed);
    drafts.push_back(*(*bound)->Sample(random, {}));
  }
  return drafts;
}

double KeyframeTime(const Draft& draft) { return draft.ik->keyframe / draft.clip.frame_rate(); }

TEST(SampleAugmentationTest, KickIsEditedAtFullExtensionOfTheKickingFoot) {
  const std::vector<Draft> drafts = Augment(Kick());
  EXPECT_EQ(drafts.front().ik->end_effector, JointRole::kRightAnkle);
  EXPECT_NEAR(KeyframeTime(drafts.front()), 0.90, 0.06);
}

TEST(SampleAugmentationTest, WalkIsEditedWhereOneFootLeads) {
  const std::vector<Draft> drafts = Augment(Walk());
  const Draft& first = drafts.front();
  EXPECT_TRUE(first.ik->end_effector == JointRole::kLeftAnkle ||
              first.ik->end_effector == JointRole::kRightAnkle);
}

TEST(SampleAugmentationTest, PunchIsEditedAtTheSteppingFootWhileTheArmIsOut) {
  const std::vector<Draft> drafts = Augment(Punch());
  EXPECT_EQ(drafts.front().ik->end_effector, JointRole::kLeftAnkle);
  EXPECT_GT(KeyframeTime(drafts.front()), 0.45);
  EXPECT_LT(KeyframeTime(drafts.front()), 0.90);
}

TEST(SampleAugmentationTest, ManyTargetsAreInReachAndVariantsStayPlausible) {
  for (const Performance& script : AllSamples()) {
    const std::vector<Draft> drafts = Augment(script);
    EXPECT_GE(std::count_if(drafts.begin(), drafts.end(),
                            [](const Draft& draft) { return draft.ik->reachable; }),
              kVariants / 4)
        << script.name;
    for (const Draft& draft : drafts) {
      const auto score =
          *motion::AssessPlausibility(draft.clip, *JointRoles::Detect(*draft.clip.skeleton()));
      EXPECT_LT(score.penetration_max_m, 0.05) << script.name;
      EXPECT_LT(score.acceleration_rms_mps2, 45) << script.name;
    }
  }
}

}  // namespace
}  // namespace poise::samples
