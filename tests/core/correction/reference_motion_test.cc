#include "core/correction/reference_motion.h"

#include <gtest/gtest.h>

#include "core/physics/floor_alignment.h"
#include "tests/core/correction/tracked_clip.h"
#include "tests/support/test_clips.h"

namespace poise::correction {
namespace {

TEST(ReferenceMotionTest, VelocitiesCarryThePoseFromFrameToFrame) {
  const TrackedClip clip = Prepare(testing::SwingingClip(200));
  const double step = 1 / clip.reference.frame_rate();
  for (int frame = 50; frame < 150; ++frame) {
    const physics::State& now = clip.reference.source_frame(frame);
    const physics::State& next = clip.reference.source_frame(frame + 1);
    const physics::Speeds mean = (now.speeds + next.speeds) / 2;
    EXPECT_LT((now.root_position + step * mean.head<3>() - next.root_position).norm(), 2e-4);
    for (int i = 1; i < physics::kMaxBodies; ++i) {
      if (clip.model->articulation().bodies[i].rigid_joint) continue;
      const Vec3 turn = step * mean.segment<3>(physics::SpeedIndex(i));
      const Quat moved = now.rotations[i] * math::FromRotationVector(turn);
      EXPECT_LT(math::GeodesicDistance(moved, next.rotations[i]), 2e-3) << "body " << i;
    }
  }
}

TEST(ReferenceMotionTest, AccelerationsAreTheChangeOfVelocities) {
  const TrackedClip clip = Prepare(testing::SwingingClip(300));
  ReferenceConfig as_it_is;
  as_it_is.preparation.enabled = false;
  const ReferenceMotion motion =
      *ReferenceMotion::Create(clip.reference.source_clip(), *clip.model, as_it_is);
  physics::Speeds speeds = motion.frame(100).speeds;
  const double step = 1.0 / 120;
  for (int frame = 100; frame < 200; ++frame) {
    speeds += step * motion.AccelerationAt((frame + 0.5) * step);
  }
  EXPECT_LT((speeds - motion.frame(200).speeds).norm(), 0.1);
}

TEST(ReferenceMotionTest, StandsOnTheFloorAndHoldsItsEnd) {
  const TrackedClip clip = Prepare(SwayingClip(1));
  for (const motion::Clip* on_floor : {&clip.reference.clip(), &clip.reference.source_clip()}) {
    EXPECT_NEAR(physics::FloorHeight(*on_floor, clip.model->shapes(), physics::FloorRule::kLowest),
                0, 1e-4);
  }
  const physics::State late = clip.reference.At(99);
  EXPECT_TRUE(late.speeds.isZero());
  EXPECT_EQ(late.root_position, clip.reference.frame(120).root_position);
  EXPECT_TRUE(clip.reference.AccelerationAt(99).isZero());
}

TEST(ReferenceMotionTest, LeadsPastAJointThatFlipsAndComesBack) {
  const TrackedClip clip = Prepare(testing::SwingingClip(200));
  motion::Clip flipped = clip.reference.source_clip();
  const int knee = 5;
  for (int frame = 80; frame < 90; ++frame) {
    flipped.rotation(frame, knee) =
        flipped.rotation(frame, knee) * math::FromRotationVector(Vec3(0, 2.8, 0));
  }
  const ReferenceMotion repaired = *ReferenceMotion::Create(flipped, *clip.model);
  ReferenceConfig as_it_is;
  as_it_is.flip_longest_s = 0;
  const ReferenceMotion kept = *ReferenceMotion::Create(flipped, *clip.model, as_it_is);
  const auto off = [&](const ReferenceMotion& motion) {
    return math::GeodesicDistance(motion.source_frame(85).rotations[knee],
                                  clip.reference.source_frame(85).rotations[knee]);
  };
  EXPECT_LT(off(repaired), 0.05);
  EXPECT_GT(off(kept), 2.7);
  EXPECT_EQ(repaired.source_clip().rotation(85, knee).coeffs(),
            flipped.rotation(85, knee).coeffs());
}

TEST(ReferenceMotionTest, RefusesClipsThatAreTooShortOrOfOtherJoints) {
  const TrackedClip clip = Prepare(SwayingClip(1));
  const auto other = ReferenceMotion::Create(testing::SwingingClip(20), *clip.model);
  EXPECT_EQ(base::ErrorReason(other.status()), "WRONG_SHAPE");
  const motion::Clip& whole = clip.reference.clip();
  const auto positions = whole.root_positions().first(3);
  const auto rotations = whole.rotations().first(3 * 16);
  const motion::Clip brief =
      *motion::Clip::Create("brief", whole.skeleton(), 120, {positions.begin(), positions.end()},
                            {rotations.begin(), rotations.end()});
  EXPECT_EQ(base::ErrorReason(ReferenceMotion::Create(brief, *clip.model).status()),
            "CLIP_TOO_SHORT");
}

}  // namespace
}  // namespace poise::correction
