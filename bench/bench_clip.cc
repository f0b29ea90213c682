#include "bench/bench_clip.h"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace poise::bench {
namespace {

using motion::Joint;
using motion::Quat;
using motion::Vec3;

motion::SkeletonPtr Hdm05LikeSkeleton() {
  std::vector<Joint> joints = {{"root", -1, Vec3::Zero(), {}}};
  // Adds a chain below `parent` and returns the index of its first joint.
  const auto chain = [&](int parent, const std::vector<std::pair<std::string, Vec3>>& links) {
    const int first = static_cast<int>(joints.size());
    for (const auto& [name, offset] : links) {
      joints.push_back({name, parent, offset, {}});
      parent = static_cast<int>(joints.size()) - 1;
    }
    return first;
  };
  for (const auto& [prefix, side] : {std::pair("l", 1.0), std::pair("r", -1.0)}) {
    const std::string p = prefix;
    chain(0, {{p + "hipjoint", Vec3::Zero()},
              {p + "femur", Vec3(side * 0.10, -0.08, 0.02)},
              {p + "tibia", Vec3(side * 0.02, -0.40, 0)},
              {p + "foot", Vec3(side * 0.02, -0.39, 0)},
              {p + "toes", Vec3(0, -0.06, 0.13)}});
  }
  const int spine = chain(0, {{"lowerback", Vec3::Zero()},
                              {"upperback", Vec3(0, 0.11, 0)},
                              {"thorax", Vec3(0, 0.11, 0)},
                              {"lowerneck", Vec3(0, 0.11, 0)},
                              {"upperneck", Vec3(0, 0.09, 0)},
                              {"head", Vec3(0, 0.09, 0)}});
  for (const auto& [prefix, side] : {std::pair("l", 1.0), std::pair("r", -1.0)}) {
    const std::string p = prefix;
    const int clavicle = chain(spine + 2, {{p + "clavicle", Vec3(0, 0.08, 0)},
                                           {p + "humerus", Vec3(side * 0.18, 0, 0)},
                                           {p + "radius", Vec3(side * 0.28, 0, 0)},
                                           {p + "wrist", Vec3(side * 0.17, 0, 0)},
                                           {p + "hand", Vec3(side * 0.08, 0, 0)},
                                           {p + "fingers", Vec3(side * 0.06, 0, 0)}});
    chain(clavicle + 3, {{p + "thumb", Vec3(side * 0.03, 0, 0.04)}});
  }
  return *motion::Skeleton::Create(std::move(joints));
}

}  // namespace

motion::Clip CapturedSizeClip(int frames, double frame_rate) {
  const motion::SkeletonPtr skeleton = Hdm05LikeSkeleton();
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
  for (int frame = 0; frame < frames; ++frame) {
    const double t = frame / frame_rate;
    positions.push_back(Vec3(0, 0.95 + 0.02 * std::sin(4 * t), 0.5 * t));
    for (int joint = 0; joint < skeleton->num_joints(); ++joint) {
      const Vec3 axis = Vec3(std::sin(joint), std::cos(joint), std::sin(2.0 * joint)).normalized();
      const double angle = 0.3 * std::sin(2 * std::numbers::pi * 0.8 * t + joint);
      rotations.push_back(Quat(Eigen::AngleAxisd(angle, axis)));
    }
  }
  return *motion::Clip::Create("captured_size", skeleton, frame_rate, std::move(positions),
                               std::move(rotations));
}

}  // namespace poise::bench
