#include "core/pipeline/augment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <thread>

#include "core/base/random.h"
#include "tests/support/test_clips.h"

namespace poise::pipeline {
namespace {

using motion::Clip;

ResolvedSource Resolve(Clip clip) {
  auto roles = *motion::JointRoles::Detect(*clip.skeleton());
  return {std::move(clip), std::move(roles)};
}

api::AugmentSpec SpecFor(const std::string& method, int sources, int variants = 4) {
  api::AugmentSpec spec;
  for (int i = 0; i < sources; ++i) spec.sources.push_back({testing::SwingingClip(8), {}});
  spec.method = method;
  spec.variants_per_source = variants;
  spec.with_plausibility = false;
  spec.seed = 7;
  return spec;
}

std::vector<ResolvedSource> SourcesFor(const api::AugmentSpec& spec) {
  std::vector<ResolvedSource> sources;
  for (size_t i = 0; i < spec.sources.size(); ++i) {
    sources.push_back(Resolve(testing::SwingingClip(120, 120, 0.3, i + 1)));
  }
  return sources;
}

std::unique_ptr<AugmentFlow> CreateFlow(const api::AugmentSpec& spec) {
  auto flow = AugmentFlow::Create(spec, SourcesFor(spec));
  EXPECT_TRUE(flow.ok()) << flow.status();
  return *std::move(flow);
}

// Every bit of a clip's numbers.
std::string Bytes(const Clip& clip) {
  std::string bytes(reinterpret_cast<const char*>(clip.rotations().data()),
                    clip.rotations().size_bytes());
  bytes.append(reinterpret_cast<const char*>(clip.root_positions().data()),
               clip.root_positions().size_bytes());
  return bytes;
}

std::vector<std::string> MakeAll(const AugmentFlow& flow, const std::vector<int64_t>& order) {
  std::vector<std::string> bytes(order.size());
  for (const int64_t ordinal : order) bytes[ordinal] = Bytes(flow.Make(ordinal, {})->clip);
  return bytes;
}

std::vector<int64_t> InOrder(const AugmentFlow& flow) {
  std::vector<int64_t> order(flow.num_variants());
  std::iota(order.begin(), order.end(), 0);
  return order;
}

TEST(AugmentFlowTest, VariantsAreNumberedNamedAndSeededPerSource) {
  const auto flow = CreateFlow(SpecFor("ik+timewarp", 2, 3));
  ASSERT_EQ(flow->num_variants(), 6);
  const auto variant = flow->Make(4, {});
  ASSERT_TRUE(variant.ok());
  EXPECT_EQ(variant->source_index, 1);
  EXPECT_EQ(variant->index, 1);
  EXPECT_EQ(variant->clip.name(), "swing_ik+timewarp_1");
  EXPECT_EQ(variant->seed, base::DeriveSeed(7, {1, 1}));
  EXPECT_TRUE(variant->ik.has_value());
  EXPECT_FALSE(variant->plausibility.has_value());
}

TEST(AugmentFlowTest, PlausibilityIsThatOfTheVariant) {
  auto spec = SpecFor("ik", 1);
  spec.with_plausibility = true;
  const auto variant = CreateFlow(spec)->Make(1, {});
  ASSERT_TRUE(variant.ok()) << variant.status();
  ASSERT_TRUE(variant->plausibility.has_value());
  const auto expected = motion::AssessPlausibility(
      variant->clip, *motion::JointRoles::Detect(*variant->clip.skeleton()));
  EXPECT_EQ(variant->plausibility->acceleration_rms_mps2, expected->acceleration_rms_mps2);
}

TEST(AugmentFlowTest, OrderDoesNotChangeAVariant) {
  const auto spec = SpecFor("ik+timewarp+noise+mirror", 2);
  const auto flow = CreateFlow(spec);
  auto order = InOrder(*flow);
  const auto expected = MakeAll(*flow, order);
  std::reverse(order.begin(), order.end());
  EXPECT_EQ(MakeAll(*CreateFlow(spec), order), expected);
}

TEST(AugmentFlowTest, ThreadsDoNotChangeAVariant) {
  const auto spec = SpecFor("ik+timewarp+noise", 3, 8);
  const auto expected_flow = CreateFlow(spec);
  const auto expected = MakeAll(*expected_flow, InOrder(*expected_flow));
  const auto flow = CreateFlow(spec);
  std::vector<std::string> got(expected.size());
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&, thread] {
      for (size_t i = thread; i < got.size(); i += 4) got[i] = Bytes(flow->Make(i, {})->clip);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(got, expected);
}

TEST(AugmentFlowTest, AnotherSeedGivesOtherVariants) {
  auto spec = SpecFor("ik", 1);
  const auto first = MakeAll(*CreateFlow(spec), {0, 1, 2, 3});
  EXPECT_NE(first[0], first[1]);
  spec.seed = 8;
  EXPECT_NE(MakeAll(*CreateFlow(spec), {0, 1, 2, 3})[0], first[0]);
}

TEST(AugmentFlowTest, AFurtherStepDoesNotChangeTheDrawsOfTheFirst) {
  const auto alone = CreateFlow(SpecFor("ik", 1))->Make(2, {});
  const auto chained = CreateFlow(SpecFor("ik+noise", 1))->Make(2, {});
  EXPECT_EQ(alone->ik->target, chained->ik->target);
  EXPECT_NE(Bytes(alone->clip), Bytes(chained->clip));
}

TEST(AugmentFlowTest, ACancelledCallStops) {
  const auto flow = CreateFlow(SpecFor("ik", 1));
  base::RunContext context;
  context.cancellation.Cancel();
  EXPECT_EQ(flow->Make(0, context).status().code(), absl::StatusCode::kCancelled);
  base::RunContext late;
  late.deadline = absl::UnixEpoch();
  EXPECT_EQ(flow->Make(0, late).status().code(), absl::StatusCode::kDeadlineExceeded);
  EXPECT_TRUE(flow->Make(0, {}).ok());
}

TEST(AugmentFlowTest, MistakesAreToldBeforeAnyWork) {
  const auto reason = [](const api::AugmentSpec& spec) {
    return base::ErrorReason(AugmentFlow::Create(spec, SourcesFor(spec)).status());
  };
  auto spec = SpecFor("ki", 1);
  EXPECT_EQ(reason(spec), "UNKNOWN_METHOD");
  spec = SpecFor("ik", 1);
  spec.action_class = "dance";
  EXPECT_EQ(reason(spec), "UNKNOWN_ACTION_CLASS");
  spec = SpecFor("ik", 1);
  spec.overrides = {{"ik.radius", "1"}};
  EXPECT_EQ(reason(spec), "UNKNOWN_CONFIG_KEY");
  EXPECT_EQ(reason(SpecFor("ik", 0)), "EMPTY_REQUEST");
}

TEST(AugmentFlowTest, AnUnfitClipNamesItsSource) {
  const auto spec = SpecFor("ik", 2);
  auto sources = SourcesFor(spec);
  sources[1] = Resolve(testing::SwingingClip(2));
  Status status = AugmentFlow::Create(spec, sources).status();
  EXPECT_EQ(base::ErrorReason(status), "CLIP_TOO_SHORT");
  EXPECT_EQ(base::ErrorField(status), "sources[1]");
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);

  const auto chain = *motion::Skeleton::Create({{"a", -1, motion::Vec3::Zero(), {}}});
  sources[1].roles = *motion::JointRoles::Detect(*chain);
  status = AugmentFlow::Create(spec, sources).status();
  EXPECT_EQ(base::ErrorReason(status), "MISSING_ROLES");
  EXPECT_EQ(base::ErrorField(status), "sources[1].joint_roles");
}

}  // namespace
}  // namespace poise::pipeline
