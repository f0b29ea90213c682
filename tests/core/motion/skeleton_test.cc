#include "core/motion/skeleton.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

TEST(SkeletonTest, KnowsParentsChildrenAndTheWayToTheRoot) {
  const SkeletonPtr skeleton = testing::Biped();
  const int knee = *skeleton->Find("left_knee"), hip = *skeleton->Find("left_hip");
  EXPECT_EQ(skeleton->parent(knee), hip);
  ASSERT_EQ(skeleton->children(hip).size(), 1u);
  EXPECT_EQ(skeleton->children(hip)[0], knee);
  EXPECT_EQ(skeleton->ChainToRoot(knee), (std::vector<int>{knee, hip, 0}));
  EXPECT_FALSE(skeleton->Find("Left_Knee").has_value());
}

TEST(SkeletonTest, EachMalformedTreeHasItsReason) {
  const Vec3 o = Vec3::Zero();
  const auto reason = [](std::vector<Joint> joints) {
    return base::ErrorReason(Skeleton::Create(std::move(joints)).status());
  };
  EXPECT_EQ(reason({}), "EMPTY_SKELETON");
  EXPECT_EQ(reason(std::vector<Joint>(Skeleton::kMaxJoints + 1)), "TOO_MANY_JOINTS");
  EXPECT_EQ(reason({{"a", -1, o, {}}, {"a", 0, o, {}}}), "DUPLICATE_JOINT");
  EXPECT_EQ(reason({{"a", 0, o, {}}}), "BAD_PARENT");
  EXPECT_EQ(reason({{"a", -1, o, {}}, {"b", -1, o, {}}}), "BAD_PARENT");
  EXPECT_EQ(reason({{"a", -1, o, {}}, {"b", 2, o, {}}, {"c", 1, o, {}}}), "BAD_PARENT");
  const Vec3 bad(0, std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_EQ(reason({{"a", -1, bad, {}}}), "NOT_FINITE");
  EXPECT_EQ(reason({{"a", -1, o, bad}}), "NOT_FINITE");
}

TEST(SkeletonTest, SameAsComparesNamesParentsAndOffsets) {
  const SkeletonPtr skeleton = testing::Biped();
  std::vector<Joint> joints = skeleton->joints();
  EXPECT_TRUE(skeleton->SameAs(**Skeleton::Create(joints)));
  joints[3].offset.x() += 1e-4;
  EXPECT_FALSE(skeleton->SameAs(**Skeleton::Create(joints)));
  EXPECT_TRUE(skeleton->SameAs(**Skeleton::Create(joints), 1e-3));
  joints[3].name = "nape";
  EXPECT_FALSE(skeleton->SameAs(**Skeleton::Create(joints), 1e-3));
}

}  // namespace
}  // namespace poise::motion
