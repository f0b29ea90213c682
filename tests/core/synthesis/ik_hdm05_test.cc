#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "core/motion/io/clip_file.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "core/synthesis/ik/ik_synthesizer.h"
#include "tests/support/data_files.h"

/// IK synthesis on captured motion: what it promises, measured from outside by forward kinematics.
namespace poise::synthesis {
namespace {

using motion::Clip;
using motion::JointRole;
using motion::JointRoles;
using motion::Vec3;
using motion::WorldPoses;

struct Capture {
  Draft draft;
  JointRoles roles;
  WorldPoses poses;
};

std::vector<Capture> ReadCaptures(const std::string& folder) {
  std::vector<Capture> captures;
  for (const auto& path : testing::DataFiles(folder, {".amc"})) {
    auto file = motion::ReadClipFile(path);
    EXPECT_TRUE(file.ok()) << file.status();
    JointRoles roles = *JointRoles::Detect(*file->clip.skeleton());
    WorldPoses poses = motion::ForwardKinematics(file->clip);
    captures.push_back({{std::move(file->clip), std::nullopt}, std::move(roles), std::move(poses)});
  }
  return captures;
}

IkSynthesizer Make(const std::string& action_class, const std::string& preset = "recommended") {
  const ActionClass found = *FindActionClass(action_class);
  return IkSynthesizer(found, *IkConfig::FromPreset(preset, found));
}

// The three joints that IK synthesis may touch.
std::array<int, 3> LimbOf(const JointRoles& roles, JointRole end) {
  const int first = static_cast<int>(end) - 2;
  return {roles.joint(static_cast<JointRole>(first)),
          roles.joint(static_cast<JointRole>(first + 1)), roles.joint(end)};
}

// Root mean square over frames of the second difference of a curve [m/s^2].
double AccelerationRms(const std::vector<Vec3>& curve, double frame_rate) {
  double sum = 0;
  for (size_t i = 1; i + 1 < curve.size(); ++i) {
    sum += (curve[i - 1] - 2 * curve[i] + curve[i + 1]).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(curve.size() - 2)) * frame_rate * frame_rate;
}

std::vector<Vec3> CurveOf(const WorldPoses& poses, int joint) {
  std::vector<Vec3> curve;
  for (int frame = 0; frame < poses.num_frames; ++frame) {
    curve.push_back(poses.position(frame, joint));
  }
  return curve;
}

// How much a joint's acceleration exceeds 1.5 times the source's plus what the displacement
// implies, as a factor (at most 1 is within the bound). What the displacement implies: the
// end effector is asked to move by weight(t) * D, so its acceleration grows by that curve's; the
// middle joint moves `gain` times as far as the end (largest ratio over the clip), so by `gain`
// times as much.
double AccelerationExcess(const std::vector<Vec3>& before, const std::vector<Vec3>& after,
                          const std::vector<Vec3>& asked, double frame_rate) {
  double gain = 0;
  double largest = 0;
  for (const Vec3& displacement : asked) largest = std::max(largest, displacement.norm());
  for (size_t i = 0; i < asked.size(); ++i) {
    // Ratios of tiny numbers say nothing.
    if (asked[i].norm() < 0.1 * largest) continue;
    gain = std::max(gain, (after[i] - before[i]).norm() / asked[i].norm());
  }
  return AccelerationRms(after, frame_rate) /
         (1.5 * AccelerationRms(before, frame_rate) + gain * AccelerationRms(asked, frame_rate));
}

// The recommended preset's weight, written down a second time.
double MinimumJerkWindow(int frame, int keyframe, double frame_rate) {
  const double u = std::max(0.0, 1 - std::abs(frame - keyframe) / (0.4 * frame_rate));
  return std::pow(u, 3) * (10 - 15 * u + 6 * u * u);
}

void ExpectOnlyLimbTouched(const Capture& source, const Draft& variant, const WorldPoses& poses) {
  const Clip& clip = source.draft.clip;
  const auto limb = LimbOf(source.roles, variant.ik->end_effector);
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    ASSERT_EQ(variant.clip.root_position(frame), clip.root_position(frame));
    for (int joint = 0; joint < clip.num_joints(); ++joint) {
      if (std::find(limb.begin(), limb.end(), joint) == limb.end()) {
        ASSERT_EQ(variant.clip.rotation(frame, joint).coeffs(),
                  clip.rotation(frame, joint).coeffs());
      }
      const int parent = clip.skeleton()->parent(joint);
      if (parent < 0) continue;
      ASSERT_NEAR((poses.position(frame, joint) - poses.position(frame, parent)).norm(),
                  clip.skeleton()->joint(joint).offset.norm(), 1e-6);
    }
  }
}

TEST(IkHdm05Test, AThousandFansOverAllKicksKeepEveryPromise) {
  POISE_REQUIRE_DATA("hdm05/kickLFront1Reps");
  const auto captures = ReadCaptures("hdm05/kickLFront1Reps");
  const IkSynthesizer synthesizer = Make("kick");
  int unreachable = 0;
  double worst_error = 0, worst_end = 0, worst_middle = 0;
  for (int i = 0; i < 1000; ++i) {
    const Capture& source = captures[i % captures.size()];
    const auto bound = *synthesizer.Bind(source.draft, source.roles);
    base::Random random(i);
    const Draft variant = *bound->Sample(random, {});
    const WorldPoses poses = motion::ForwardKinematics(variant.clip);
    const auto limb = LimbOf(source.roles, variant.ik->end_effector);
    const int key = variant.ik->keyframe;

    const double error = (poses.position(key, limb[2]) - variant.ik->target).norm();
    EXPECT_NEAR(error, variant.ik->reached_error_m, 1e-9);
    // The shell of reference sec. 3.5 step 2.
    const double upper =
        (source.poses.position(key, limb[1]) - source.poses.position(key, limb[0])).norm();
    const double lower =
        (source.poses.position(key, limb[2]) - source.poses.position(key, limb[1])).norm();
    const double radius = (variant.ik->target - source.poses.position(key, limb[0])).norm();
    const bool reachable =
        radius >= std::abs(upper - lower) + 1e-3 && radius <= 0.999 * (upper + lower);
    EXPECT_EQ(variant.ik->reachable, reachable);
    if (reachable) {
      worst_error = std::max(worst_error, error);
    } else {
      ++unreachable;
    }
    ExpectOnlyLimbTouched(source, variant, poses);

    const double rate = variant.clip.frame_rate();
    std::vector<Vec3> asked;
    for (int frame = 0; frame < variant.clip.num_frames(); ++frame) {
      asked.push_back(MinimumJerkWindow(frame, key, rate) *
                      (variant.ik->target - source.poses.position(key, limb[2])));
    }
    const auto excess = [&](int joint) {
      return AccelerationExcess(CurveOf(source.poses, joint), CurveOf(poses, joint), asked, rate);
    };
    worst_end = std::max(worst_end, excess(limb[2]));
    worst_middle = std::max(worst_middle, excess(limb[1]));
  }
  EXPECT_LT(worst_error, 1e-3);
  EXPECT_LE(worst_end, 1);
  EXPECT_LE(worst_middle, 1);
  std::printf(
      "1000 fans over %zu kicks: %d targets outside the reachable shell; worst error inside "
      "%.2e m; acceleration at most %.3f (ankle) and %.3f (knee) of the bound\n",
      captures.size(), unreachable, worst_error, worst_end, worst_middle);
}

// How many clips of a folder are edited at the end effector that their name tells.
int EditedAsNamed(const std::vector<Capture>& captures, const std::string& action_class,
                  JointRole named) {
  const IkSynthesizer synthesizer = Make(action_class);
  return static_cast<int>(std::count_if(captures.begin(), captures.end(), [&](const Capture& c) {
    base::Random random(1);
    const auto bound = *synthesizer.Bind(c.draft, c.roles);
    return (*bound->Sample(random, {})).ik->end_effector == named;
  }));
}

TEST(IkHdm05Test, TheActiveLimbIsTheOneThatTheClassNames) {
  POISE_REQUIRE_DATA("hdm05");
  const auto kicks = ReadCaptures("hdm05/kickLFront1Reps");
  EXPECT_EQ(EditedAsNamed(kicks, "kick", JointRole::kLeftAnkle), kicks.size());
  const auto grabs = ReadCaptures("hdm05/grabHighR");
  EXPECT_EQ(EditedAsNamed(grabs, "grab", JointRole::kRightWrist), grabs.size());
  // Who bends to the floor stretches the other arm backwards, now and then farther.
  const auto deposits = ReadCaptures("hdm05/depositFloorR");
  EXPECT_GE(EditedAsNamed(deposits, "deposit", JointRole::kRightWrist), 0.9 * deposits.size());
}

TEST(IkHdm05Test, EveryClassWorksOnMotionOfItsKind) {
  POISE_REQUIRE_DATA("hdm05");
  const std::map<std::string, std::string> folders = {
      {"kick", "kickLFront1Reps"},    {"punch", "rotateArmsBothBackward1Reps"},
      {"walk", "sneak2StepsLStart"},  {"jog", "jogLeftCircle4StepsRstart"},
      {"sneak", "sneak2StepsLStart"}, {"grab", "grabHighR"},
      {"deposit", "depositFloorR"},   {"throw", "throwBasketball"}};
  for (const ActionClass& action_class : ActionClasses()) {
    const auto captures = ReadCaptures("hdm05/" + folders.at(action_class.name));
    for (const std::string preset : {"recommended", "paper"}) {
      const auto synthesizer = Make(action_class.name, preset);
      int reachable = 0, unreachable = 0;
      for (size_t i = 0; i < captures.size(); ++i) {
        const auto bound = *synthesizer.Bind(captures[i].draft, captures[i].roles);
        for (int repetition = 0; repetition < 5; ++repetition) {
          base::Random random(100 * i + repetition);
          const Draft variant = *bound->Sample(random, {});
          ++(variant.ik->reachable ? reachable : unreachable);
          if (variant.ik->reachable) {
            EXPECT_LT(variant.ik->reached_error_m, 1e-3) << variant.clip.name();
          }
        }
      }
      EXPECT_GT(reachable, 0) << action_class.name;
      std::printf("%-8s %-12s %d targets inside the reachable shell, %d outside\n",
                  action_class.name, preset.c_str(), reachable, unreachable);
    }
  }
}

}  // namespace
}  // namespace poise::synthesis
