#include "samples/author/body.h"

#include <string>
#include <utility>
#include <vector>

namespace poise::samples {
namespace {

constexpr int kFirstLeg = 1;
constexpr int kFirstArm = 13;
constexpr int kJointsPerLimb = 4;

}  // namespace

LegJoints Leg(Side side) {
  const int first = kFirstLeg + (side == Side::kLeft ? 0 : kJointsPerLimb);
  return {first, first + 1, first + 2, first + 3};
}

ArmJoints Arm(Side side) {
  const int first = kFirstArm + (side == Side::kLeft ? 0 : kJointsPerLimb);
  return {first, first + 1, first + 2, first + 3};
}

motion::SkeletonPtr MakeBody() {
  std::vector<motion::Joint> joints = {{"Hips", -1, Vec3(0, 0, 0), {}}};
  for (const Side side : kSides) {
    const std::string name = side == Side::kLeft ? "Left" : "Right";
    const double out = Outward(side);
    const auto [hip, knee, ankle, toe] = Leg(side);
    joints.push_back({name + "UpLeg", kHips, Vec3(out * 0.090, -0.036, 0.004), {}});
    joints.push_back({name + "Leg", hip, Vec3(0, -kThigh, 0), {}});
    joints.push_back({name + "Foot", knee, Vec3(0, -kShank, 0), {}});
    joints.push_back({name + "ToeBase", ankle, kBallFromAnkle, Vec3(0, 0, kToeLength)});
  }
  joints.push_back({"Spine", kHips, Vec3(0, 0.095, -0.012), {}});
  joints.push_back({"Spine1", kSpine, Vec3(0, 0.165, -0.008), {}});
  joints.push_back({"Neck", kChest, Vec3(0, 0.242, 0.004), {}});
  joints.push_back({"Head", kNeck, Vec3(0, 0.092, 0.018), Vec3(0, 0.198, 0.004)});
  for (const Side side : kSides) {
    const std::string name = side == Side::kLeft ? "Left" : "Right";
    const double out = Outward(side);
    const auto [collar, shoulder, elbow, wrist] = Arm(side);
    joints.push_back({name + "Shoulder", kChest, Vec3(out * 0.028, 0.188, 0.010), {}});
    joints.push_back({name + "Arm", collar, Vec3(out * 0.150, -0.004, -0.012), {}});
    joints.push_back({name + "ForeArm", shoulder, Vec3(out * kUpperArm, 0, 0), {}});
    joints.push_back(
        {name + "Hand", elbow, Vec3(out * kForearm, 0, 0), Vec3(out * 0.175, -0.005, 0.012)});
  }
  return *motion::Skeleton::Create(std::move(joints));
}

}  // namespace poise::samples
