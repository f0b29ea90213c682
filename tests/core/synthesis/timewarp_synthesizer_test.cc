#include "core/synthesis/timewarp/timewarp_synthesizer.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/test_clips.h"

namespace poise::synthesis {
namespace {

TEST(TimewarpSynthesizerTest, DurationsFillTheRangeAndBothEndPosesStay) {
  const Draft source{testing::SwingingClip(361), std::nullopt};
  const motion::JointRoles roles = *motion::JointRoles::Detect(*source.clip.skeleton());
  const TimewarpSynthesizer synthesizer{TimewarpConfig{}};
  const auto bound = *synthesizer.Bind(source, roles);
  int shortest = 361, longest = 361;
  for (uint64_t seed = 0; seed < 200; ++seed) {
    base::Random random(seed);
    const Draft variant = *bound->Sample(random, {});
    shortest = std::min(shortest, variant.clip.num_frames());
    longest = std::max(longest, variant.clip.num_frames());
    const int last = variant.clip.num_frames() - 1;
    EXPECT_EQ(variant.clip.frame_rate(), 120);
    EXPECT_EQ(variant.clip.root_position(last), source.clip.root_position(360));
    EXPECT_EQ(variant.clip.rotation(0, 5).coeffs(), source.clip.rotation(0, 5).coeffs());
  }
  // 360 steps, 10 % either way.
  EXPECT_GE(shortest, 325);
  EXPECT_LE(shortest, 329);
  EXPECT_LE(longest, 397);
  EXPECT_GE(longest, 393);
}

TEST(TimewarpSynthesizerTest, AClipOfOneFrameIsRefused) {
  const motion::Clip clip = testing::SwingingClip(1);
  const motion::JointRoles roles = *motion::JointRoles::Detect(*clip.skeleton());
  EXPECT_EQ(base::ErrorReason(TimewarpSynthesizer(TimewarpConfig{}).Check(clip, roles)),
            "CLIP_TOO_SHORT");
}

}  // namespace
}  // namespace poise::synthesis
