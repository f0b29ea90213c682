#include "samples/author/samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "core/motion/io/clip_file.h"
#include "core/motion/joint_roles.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "core/motion/metrics/plausibility.h"

namespace poise::samples {
namespace {

using motion::Clip;
using motion::JointRole;
using motion::JointRoles;
using motion::WorldPoses;

constexpr double kDegree = std::numbers::pi / 180;

class SamplesTest : public ::testing::TestWithParam<const char*> {
 protected:
  static Performance Script() {
    const std::vector<Performance> all = AllSamples();
    return *std::find_if(all.begin(), all.end(),
                         [](const Performance& script) { return script.name == GetParam(); });
  }

  const Clip clip_ = *Perform(Script());
  const WorldPoses poses_ = motion::ForwardKinematics(clip_);
};

INSTANTIATE_TEST_SUITE_P(All, SamplesTest, ::testing::Values("kick", "walk", "punch"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(SamplesTest, CommittedFileIsWhatTheProgramWrites) {
  std::ifstream file(std::string(POISE_SAMPLES_DIR) + "/" + GetParam() + ".bvh", std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_TRUE(text.str() == motion::EncodeBvh(clip_))
      << "write it again: poise_author_samples samples";
}

TEST_P(SamplesTest, FileIsReadWithEveryRoleAndTheRightUnit) {
  const auto read =
      motion::ReadClipFile(std::string(POISE_SAMPLES_DIR) + "/" + GetParam() + ".bvh");
  ASSERT_TRUE(read.ok()) << base::Message(read.status());
  EXPECT_DOUBLE_EQ(read->convention.unit_m, 0.01);
  EXPECT_NEAR(read->clip.frame_rate(), 120, 0.01);
  EXPECT_TRUE(read->clip.skeleton()->SameAs(*clip_.skeleton(), 1e-6));
  const JointRoles roles = *JointRoles::Detect(*read->clip.skeleton());
  for (int role = 0; role < motion::kNumRoles; ++role) {
    EXPECT_TRUE(roles.has(static_cast<JointRole>(role)))
        << motion::RoleName(static_cast<JointRole>(role));
  }
  for (int frame = 0; frame < clip_.num_frames(); ++frame) {
    for (int joint = 0; joint < clip_.num_joints(); ++joint) {
      ASSERT_LT(
          math::GeodesicDistance(read->clip.rotation(frame, joint), clip_.rotation(frame, joint)),
          1e-5);
    }
  }
}

TEST_P(SamplesTest, KneesAndElbowsBendTheRightWayWithinTheirRange) {
  for (int frame = 0; frame < clip_.num_frames(); ++frame) {
    for (const Side side : kSides) {
      const Vec3 knee = math::ToRotationVector(clip_.rotation(frame, Leg(side).knee));
      EXPECT_LT(knee.tail<2>().norm(), 1e-9);
      EXPECT_GT(knee.x(), 4 * kDegree) << frame;
      EXPECT_LT(knee.x(), 140 * kDegree) << frame;
      const Vec3 elbow = math::ToRotationVector(clip_.rotation(frame, Arm(side).elbow));
      EXPECT_NEAR(elbow.x(), 0, 1e-9);
      EXPECT_NEAR(elbow.z(), 0, 1e-9);
      EXPECT_GT(-Outward(side) * elbow.y(), 4 * kDegree) << frame;
      EXPECT_LT(-Outward(side) * elbow.y(), 145 * kDegree) << frame;
      const Vec3 ankle = math::ToRotationVector(clip_.rotation(frame, Leg(side).ankle));
      EXPECT_LT(ankle.norm(), 50 * kDegree) << frame;
    }
  }
}

TEST_P(SamplesTest, SolesNeverSinkAndSomethingAlwaysStands) {
  for (int frame = 0; frame < clip_.num_frames(); ++frame) {
    double lowest = 1;
    for (const Side side : kSides) {
      const LegJoints leg = Leg(side);
      const double sole = kAnkleHeight + kBallFromAnkle.y();
      for (const Vec3& point :
           {poses_.Point(frame, leg.ankle, Vec3(0, -kAnkleHeight, -kHeelBehindAnkle)),
            poses_.Point(frame, leg.toe, Vec3(0, -sole, 0)),
            poses_.Point(frame, leg.toe, Vec3(0, -sole, kToeLength))}) {
        lowest = std::min(lowest, point.y());
      }
    }
    EXPECT_GT(lowest, -0.003) << frame;
    EXPECT_LT(lowest, 0.003) << frame;
  }
}

TEST_P(SamplesTest, FeetDoNotSlideWhileTheyStand) {
  const double rate = clip_.frame_rate();
  for (const Side side : kSides) {
    const int toe = Leg(side).toe;
    double slide = 0;
    int standing = 0;
    for (int frame = 1; frame < clip_.num_frames(); ++frame) {
      if (poses_.position(frame, toe).y() > 0.025) continue;
      Vec3 step = poses_.position(frame, toe) - poses_.position(frame - 1, toe);
      step.y() = 0;
      slide += step.norm() * rate;
      ++standing;
    }
    ASSERT_GT(standing, 20);
    EXPECT_LT(slide / standing, 0.05);
  }
}

TEST_P(SamplesTest, IsPlausible) {
  const auto score = motion::AssessPlausibility(clip_, *JointRoles::Detect(*clip_.skeleton()));
  ASSERT_TRUE(score.ok()) << base::Message(score.status());
  // The measure's foot is one box to the tip of the toes. Toes that bend under a rising heel sink
  // and slide by its lights; captured kicks and walks score 0.065 to 0.65 m/s here.
  EXPECT_LT(score->foot_skate_mps, 0.2);
  EXPECT_LT(score->penetration_max_m, 0.02);
  EXPECT_LT(score->float_mean_m, 0.01);
  EXPECT_LT(score->self_penetration_max_m, 0.03);
  // The same clips lie between 7 and 22 m/s^2, and between 160 and 3300 m/s^3.
  EXPECT_LT(score->acceleration_rms_mps2, 22);
  EXPECT_LT(score->jerk_rms_mps3, 1500);
}

TEST(SampleScriptsTest, KickIsHighAndFast) {
  const Clip clip = *Perform(Kick());
  const WorldPoses poses = motion::ForwardKinematics(clip);
  const int ankle = Leg(Side::kRight).ankle;
  double highest = 0, fastest = 0;
  for (int frame = 1; frame < clip.num_frames(); ++frame) {
    highest = std::max(highest, poses.position(frame, ankle).y());
    fastest = std::max(
        fastest, (poses.position(frame, ankle) - poses.position(frame - 1, ankle)).norm() * 120);
  }
  EXPECT_GT(highest, 1.0);
  EXPECT_LT(highest, 1.3);
  EXPECT_GT(fastest, 5);
  EXPECT_LT(fastest, 12.6);
}

TEST(SampleScriptsTest, PunchReachesAheadAtShoulderHeight) {
  const Clip clip = *Perform(Punch());
  const WorldPoses poses = motion::ForwardKinematics(clip);
  double furthest = 0, height = 0;
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    const Vec3& wrist = poses.position(frame, Arm(Side::kRight).wrist);
    const double ahead = wrist.z() - poses.position(frame, kHips).z();
    if (ahead <= furthest) continue;
    furthest = ahead;
    height = wrist.y();
  }
  EXPECT_GT(furthest, 0.6);
  EXPECT_NEAR(height, 1.35, 0.1);
}

TEST(SampleScriptsTest, WalkKeepsAComfortablePaceAndGoesStraight) {
  const Clip clip = *Perform(Walk());
  const Vec3 way = clip.root_position(clip.num_frames() - 1) - clip.root_position(0);
  EXPECT_NEAR(way.z() / clip.duration(), 1.2, 0.1);
  EXPECT_LT(std::abs(way.x()), 0.05);
}

}  // namespace
}  // namespace poise::samples
