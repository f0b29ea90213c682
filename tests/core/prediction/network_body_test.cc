#include "core/prediction/network_body.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/test_clips.h"

namespace poise::prediction {
namespace {

motion::BenchmarkClips Benchmark() {
  motion::BenchmarkClips clips;
  clips.train.push_back({"swing", "", testing::SwingingClip(10, 60)});
  clips.counts.assign(3 * testing::Biped()->num_joints(), false);
  clips.counts[0] = clips.counts[3 * 4 + 1] = clips.counts[3 * 7] = clips.counts[3 * 7 + 2] = true;
  return clips;
}

TEST(NetworkBodyTest, HoldsTheJointsWithAColumnThatCountsButNotTheRoot) {
  const NetworkBody body = NetworkBody::Of(Benchmark());
  EXPECT_THAT(body.joints, ::testing::ElementsAre(4, 7));
  EXPECT_EQ(body.frame_rate, 60);
}

TEST(NetworkBodyTest, SurvivesJson) {
  const NetworkBody body = NetworkBody::Of(Benchmark());
  const auto back = NetworkBody::FromJson(body.ToJson());
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_TRUE(back->skeleton->SameAs(*body.skeleton));
  EXPECT_EQ(back->skeleton->joint(5).end_site.has_value(),
            body.skeleton->joint(5).end_site.has_value());
  EXPECT_EQ(back->joints, body.joints);
  EXPECT_EQ(back->frame_rate, 60);
}

TEST(NetworkBodyTest, CardsWithoutABodyAreRefused) {
  base::Json json = NetworkBody::Of(Benchmark()).ToJson();
  json["joints"] = {99};
  EXPECT_EQ(base::ErrorReason(NetworkBody::FromJson(json).status()), "MALFORMED_CARD");
  json.erase("joints");
  EXPECT_EQ(base::ErrorReason(NetworkBody::FromJson(json).status()), "MALFORMED_CARD");
  EXPECT_EQ(base::ErrorReason(NetworkBody::FromJson("no object").status()), "MALFORMED_CARD");
}

}  // namespace
}  // namespace poise::prediction
