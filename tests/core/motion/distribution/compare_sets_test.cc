#include "core/motion/distribution/compare_sets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/motion/dataset/clip_folder.h"
#include "core/motion/editing/resample.h"
#include "tests/support/data_files.h"
#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

StatusOr<MotionFeatures> Describe(const Clip& clip) {
  POISE_ASSIGN_OR_RETURN(const JointRoles roles, JointRoles::Detect(*clip.skeleton()));
  return DescribeMotion(clip, roles);
}

// Swings that differ by their seed.
std::vector<MotionFeatures> Swings(uint64_t first, int count, double amplitude) {
  std::vector<MotionFeatures> motions;
  for (int i = 0; i < count; ++i) {
    const auto features = Describe(testing::SwingingClip(90, 120, amplitude, first + i));
    EXPECT_TRUE(features.ok()) << features.status();
    if (features.ok()) motions.push_back(*features);
  }
  return motions;
}

SetComparison Compare(const MotionSets& sets) {
  const auto comparison = CompareSets(sets, {}, {});
  EXPECT_TRUE(comparison.ok()) << comparison.status();
  return comparison.value_or(SetComparison{});
}

TEST(MotionFeaturesTest, PlaceAndRateDoNotCount) {
  const Clip clip = testing::SwingingClip(121, 120, 0.3, 4);
  const auto slow = Resample(clip, 60);
  ASSERT_TRUE(slow.ok());
  const auto a = Describe(clip), b = Describe(*slow);
  ASSERT_TRUE(a.ok() && b.ok()) << a.status() << b.status();
  EXPECT_EQ(a->rotations.cols(), 135);
  EXPECT_EQ(a->rotations.rows(), 31);
  EXPECT_EQ(a->descriptor.size(), 32 * 99 + 1);
  EXPECT_LT(DtwDistance(a->rotations, b->rotations), 0.02);
  EXPECT_NEAR(a->mean_speed_mps, b->mean_speed_mps, 0.02 * a->mean_speed_mps);
}

TEST(MotionFeaturesTest, TheDistanceOfTwoFramesIsNearlyTheAngle) {
  const Clip clip = testing::SwingingClip(40, 120, 0.3, 4);
  const auto roles = JointRoles::Detect(*clip.skeleton());
  ASSERT_TRUE(roles.ok()) << roles.status();
  Clip turned = clip;
  const math::Quat turn(Eigen::AngleAxisd(0.2, math::Vec3(1, 2, 3).normalized()));
  for (const JointRole role : {JointRole::kRightElbow, JointRole::kLeftKnee}) {
    for (int frame = 0; frame < turned.num_frames(); ++frame) {
      turned.rotation(frame, roles->joint(role)) = clip.rotation(frame, roles->joint(role)) * turn;
    }
  }
  const auto a = Describe(clip), b = Describe(turned);
  ASSERT_TRUE(a.ok() && b.ok()) << a.status() << b.status();
  EXPECT_NEAR((a->rotations.row(3) - b->rotations.row(3)).norm(),
              std::sqrt(2.0) * 2 * std::sin(0.1), 1e-6);
}

TEST(CompareSetsTest, ACopyOfTheTrainingSetIsAsDiverseAndNotNew) {
  const MotionSets sets{Swings(1, 6, 0.3), Swings(1, 6, 0.3), Swings(20, 6, 0.3)};
  const SetComparison comparison = Compare(sets);
  EXPECT_DOUBLE_EQ(comparison.diversity, comparison.diversity_training);
  EXPECT_DOUBLE_EQ(comparison.min_dtw, comparison.min_dtw_training);
  EXPECT_NEAR(comparison.mmd, comparison.mmd_training, 1e-12);
  EXPECT_DOUBLE_EQ(comparison.mean_speed_mps, comparison.mean_speed_training_mps);
  EXPECT_EQ(comparison.novelty, 0);
  EXPECT_EQ(comparison.odd_lengths, 0);
}

TEST(CompareSetsTest, DiversityAndNoveltyAreMeansOfDistances) {
  const MotionSets sets{Swings(40, 3, 0.3), Swings(1, 4, 0.3), Swings(20, 3, 0.3)};
  const SetComparison comparison = Compare(sets);
  const auto distance = [&](int i, int j) {
    return DtwDistance(sets.made[i].rotations, sets.made[j].rotations);
  };
  EXPECT_DOUBLE_EQ(comparison.diversity, (distance(1, 0) + distance(2, 0) + distance(2, 1)) / 3);
  double novelty = 0;
  for (const MotionFeatures& made : sets.made) {
    double nearest = 1e9;
    for (const MotionFeatures& training : sets.training) {
      nearest = std::min(nearest, DtwDistance(made.rotations, training.rotations));
    }
    novelty += nearest / 3;
  }
  EXPECT_NEAR(comparison.novelty, novelty, 1e-12);
  EXPECT_EQ(comparison.nearest_of, 3);
}

TEST(CompareSetsTest, TheNearestIsTheMeanOverAllSubsets) {
  const MotionSets sets{Swings(40, 5, 0.3), Swings(1, 4, 0.3), Swings(20, 2, 0.3)};
  const auto comparison = CompareSets(sets, {.mmd = {}, .nearest_of = 2}, {});
  ASSERT_TRUE(comparison.ok()) << comparison.status();
  double mean = 0;
  for (const MotionFeatures& reference : sets.reference) {
    const auto distance = [&](int i) {
      return DtwDistance(reference.rotations, sets.made[i].rotations);
    };
    for (int i = 0; i < 5; ++i) {
      for (int j = 0; j < i; ++j) mean += std::min(distance(i), distance(j)) / (10 * 2);
    }
  }
  EXPECT_EQ(comparison->nearest_of, 2);
  EXPECT_NEAR(comparison->min_dtw, mean, 1e-9);
}

TEST(CompareSetsTest, MotionsThatHardlyMoveAreToldApart) {
  const SetComparison still = Compare({Swings(40, 8, 0.02), Swings(1, 8, 0.3), Swings(20, 8, 0.3)});
  const SetComparison alike = Compare({Swings(40, 8, 0.3), Swings(1, 8, 0.3), Swings(20, 8, 0.3)});
  EXPECT_GT(still.mmd, 2 * alike.mmd);
  EXPECT_LT(still.mmd_p, 0.01);
  EXPECT_LT(still.mean_speed_mps, 0.85 * still.mean_speed_training_mps);
  EXPECT_LT(still.diversity, 0.5 * still.diversity_training);
}

TEST(CompareSetsTest, SetsOfOneMotionAreRefusedByName) {
  const auto two = Swings(1, 2, 0.3);
  EXPECT_EQ(base::Message(CompareSets({two, two, Swings(1, 1, 0.3)}, {}, {}).status()),
            "a set is compared by at least 2 motions, 'reference' has 1");
}

TEST(CompareSetsTest, KicksOfAnotherActorAreNearerThanJogs) {
  POISE_REQUIRE_DATA("hdm05/kickLFront1Reps");
  const auto describe = [](const char* action, const char* actor, bool others) {
    std::vector<MotionFeatures> motions;
    const auto clips = ReadClipFolder(testing::DataPath("hdm05"), {.action_class = action});
    EXPECT_TRUE(clips.ok()) << clips.status();
    for (const LabelledClip& labelled : clips->clips) {
      if ((labelled.actor == actor) == others) continue;
      const auto features = Describe(labelled.clip);
      EXPECT_TRUE(features.ok()) << features.status();
      motions.push_back(*features);
    }
    return motions;
  };
  const auto training = describe("kick", "bd", true), held_out = describe("kick", "bd", false);
  const SetComparison jogs = Compare({describe("jog", "bd", true), training, held_out});
  std::printf("kicks beside kicks of bd: mmd %.3f, min DTW %.3f; jogs: mmd %.3f, min DTW %.3f\n",
              jogs.mmd_training, jogs.min_dtw_training, jogs.mmd, jogs.min_dtw);
  EXPECT_GT(jogs.mmd, 1.5 * jogs.mmd_training);
  EXPECT_LT(jogs.mmd_p, 0.01);
  EXPECT_GT(jogs.min_dtw, jogs.min_dtw_training);
}

}  // namespace
}  // namespace poise::motion
