#include "tests/support/test_clips.h"

#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/motion/joint_roles.h"

namespace poise::testing {

using motion::Joint;
using motion::Quat;
using motion::Vec3;

motion::SkeletonPtr Biped() {
  std::vector<Joint> joints = {
      {"pelvis", -1, Vec3(0, 0, 0), {}},
      {"spine", 0, Vec3(0, 0.11, 0), {}},
      {"chest", 1, Vec3(0, 0.16, 0), {}},
      {"neck", 2, Vec3(0, 0.24, 0), {}},
      {"head", 3, Vec3(0, 0.09, 0.01), Vec3(0, 0.20, 0)},
  };
  for (const double side : {-1.0, 1.0}) {  // right is -X, left is +X
    const std::string prefix = side < 0 ? "right_" : "left_";
    const int base = static_cast<int>(joints.size());
    joints.push_back({prefix + "hip", 0, Vec3(side * 0.10, -0.06, 0), {}});
    joints.push_back({prefix + "knee", base, Vec3(0, -0.43, 0), {}});
    joints.push_back({prefix + "ankle", base + 1, Vec3(0, -0.42, 0), {}});
    joints.push_back({prefix + "toe", base + 2, Vec3(0, -0.06, 0.14), Vec3(0, 0, 0.06)});
    joints.push_back({prefix + "collar", 2, Vec3(side * 0.04, 0.18, 0), {}});
    joints.push_back({prefix + "shoulder", base + 4, Vec3(side * 0.14, 0, 0), {}});
    joints.push_back({prefix + "elbow", base + 5, Vec3(side * 0.28, 0, 0), {}});
    joints.push_back(
        {prefix + "wrist", base + 6, Vec3(side * 0.25, 0, 0), Vec3(side * 0.18, 0, 0)});
  }
  return *motion::Skeleton::Create(std::move(joints));
}

motion::Clip SwingingClip(int frames, double frame_rate, double amplitude, uint64_t seed) {
  const motion::SkeletonPtr skeleton = Biped();
  const int joints = skeleton->num_joints();
  base::Random random(seed);
  std::vector<Vec3> axes(joints);
  std::vector<double> phases(joints);
  for (int joint = 0; joint < joints; ++joint) {
    axes[joint] = Vec3(random.Normal(), random.Normal(), random.Normal()).normalized();
    phases[joint] = random.Uniform(0, 2 * std::numbers::pi);
  }
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
  for (int frame = 0; frame < frames; ++frame) {
    const double t = frame / frame_rate;
    positions.push_back(Vec3(0.1 * std::sin(t), 0.99 + 0.02 * std::sin(4 * t), 0.8 * t));
    for (int joint = 0; joint < joints; ++joint) {
      const double angle = amplitude * std::sin(2 * std::numbers::pi * 0.8 * t + phases[joint]);
      rotations.push_back(Quat(Eigen::AngleAxisd(angle, axes[joint])));
    }
  }
  return *motion::Clip::Create("swing", skeleton, frame_rate, std::move(positions),
                               std::move(rotations));
}

}  // namespace poise::testing
