#include "core/motion/io/convention_detection.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/motion/joint_roles.h"

namespace poise::motion {
namespace {

// The longest way along bones, from toes to the other side's fingers, in heights. It makes the
// bodies of HDM05, CMU, Bandai-Namco and FZJ 1.46 to 2.03 m tall.
constexpr double kLongestPathInHeights = 1.35;
constexpr double kUsualHeight = 1.7;  // [m]
constexpr double kLeastHeight = 0.9, kMostHeight = 2.4;
constexpr int kSampledFrames = 64;

// Positions of all joints in one frame, in the file's unit and axes.
void WalkFrame(const RawClip& raw, size_t frame, std::vector<Vec3>& positions) {
  const size_t joints = raw.joints.size();
  std::vector<Quat> world(joints);
  positions.resize(joints);
  for (size_t joint = 0; joint < joints; ++joint) {
    const Quat& local = raw.rotations[frame * joints + joint];
    const int parent = raw.joints[joint].parent;
    world[joint] = parent < 0 ? local : world[parent] * local;
    positions[joint] = parent < 0
                           ? raw.root_positions[frame]
                           : Vec3(positions[parent] + world[parent] * raw.joints[joint].offset);
  }
}

void WalkRestPose(const std::vector<Joint>& joints, std::vector<Vec3>& positions) {
  positions.assign(joints.size(), Vec3::Zero());
  for (size_t joint = 1; joint < joints.size(); ++joint) {
    positions[joint] = positions[joints[joint].parent] + joints[joint].offset;
  }
}

// Which joints are the body's upper and lower ends; empty lists when its joints have no roles.
struct BodyEnds {
  int top = -1;
  std::vector<int> feet;

  explicit BodyEnds(const std::vector<Joint>& joints) {
    const auto skeleton = Skeleton::Create(joints);
    if (!skeleton.ok()) return;
    const auto roles = JointRoles::Detect(**skeleton);
    if (!roles.ok()) return;
    using enum JointRole;
    for (const JointRole role : {kHead, kNeck, kChest}) {
      if (top < 0) top = roles->joint(role);
    }
    for (const auto& [left, right] :
         {std::pair(kLeftAnkle, kRightAnkle), {kLeftKnee, kRightKnee}}) {
      if (feet.empty() && roles->has(left) && roles->has(right)) {
        feet = {roles->joint(left), roles->joint(right)};
      }
    }
  }

  // Unit vector from feet to head; without roles, how far the body reaches along each axis.
  Vec3 Direction(const std::vector<Vec3>& positions) const {
    if (top >= 0 && !feet.empty()) {
      const Vec3 up = positions[top] - 0.5 * (positions[feet[0]] + positions[feet[1]]);
      return up.norm() > 0 ? Vec3(up.normalized()) : Vec3::Zero();
    }
    Vec3 low = positions[0], high = positions[0];
    for (const Vec3& position : positions) {
      low = low.cwiseMin(position);
      high = high.cwiseMax(position);
    }
    const Vec3 extent = high - low;
    return extent.norm() > 0 ? Vec3(extent.normalized()) : Vec3::Zero();
  }
};

}  // namespace

double BodyHeight(std::span<const Joint> joints) {
  std::vector<double> longest(joints.size(), 0.0);  // from the joint down to a tip
  double path = 0;
  for (size_t i = joints.size(); i-- > 0;) {
    // All children have been seen: parents come first.
    const double below =
        std::max(longest[i], joints[i].end_site ? joints[i].end_site->norm() : 0.0);
    if (joints[i].end_site) path = std::max(path, longest[i] + joints[i].end_site->norm());
    longest[i] = below;
    if (joints[i].parent < 0) continue;
    const double reach = below + joints[i].offset.norm();
    double& parent = longest[joints[i].parent];
    path = std::max(path, parent + reach);
    parent = std::max(parent, reach);
  }
  return path / kLongestPathInHeights;
}

RawClip::Stated<double> DetectUnit(std::span<const Joint> joints) {
  struct Unit {
    double metres;
    const char* name;
  };
  constexpr std::array kUnits = {Unit{1.0, "metres"}, Unit{0.01, "centimetres"},
                                 Unit{0.001, "millimetres"}, Unit{0.0254, "inches"},
                                 Unit{0.0254 / 0.45, "CMU's unit"}};
  constexpr int kMetricUnits = 3;
  const double height = BodyHeight(joints);
  if (!(height > 0) || !std::isfinite(height)) {
    return {0.01, "assumed, since the skeleton has no bones to measure"};
  }
  const auto fits = [&](const Unit& unit) {
    return height * unit.metres >= kLeastHeight && height * unit.metres <= kMostHeight;
  };
  const auto distance = [&](const Unit& unit) {
    return std::abs(std::log(height * unit.metres / kUsualHeight));
  };
  const Unit* best = std::find_if(kUnits.begin(), kUnits.begin() + kMetricUnits, fits);
  if (best == kUnits.begin() + kMetricUnits) {
    best = std::min_element(kUnits.begin(), kUnits.end(), [&](const Unit& a, const Unit& b) {
      return distance(a) < distance(b);
    });
  }
  return {best->metres,
          fmt::format("{} make the body about {:.2f} m tall{}", best->name, height * best->metres,
                      fits(*best) ? "" : ", which is unusual but nearest to a human's height")};
}

RawClip::Stated<UpAxis> DetectUpAxis(const RawClip& raw) {
  const BodyEnds ends(raw.joints);
  const double height = BodyHeight(raw.joints);
  const size_t frames = raw.root_positions.size();
  const size_t samples = std::min<size_t>(frames, kSampledFrames);
  Vec3 direction = Vec3::Zero();
  Vec3 floor_low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 floor_high = -floor_low;
  std::vector<Vec3> positions;
  for (size_t i = 0; i < samples; ++i) {
    WalkFrame(raw, samples == 1 ? 0 : i * (frames - 1) / (samples - 1), positions);
    direction += ends.Direction(positions) / static_cast<double>(samples);
    Vec3 lowest = positions[0];
    for (const Vec3& position : positions) lowest = lowest.cwiseMin(position);
    floor_low = floor_low.cwiseMin(lowest);
    floor_high = floor_high.cwiseMax(lowest);
  }
  const auto score = [&](int axis) {
    const double wander = (floor_high[axis] - floor_low[axis]) / std::max(height, 1e-12);
    return direction[axis] - std::clamp(wander, 0.0, 1.0);
  };
  const bool z_up = score(2) > score(1);
  const int axis = z_up ? 2 : 1;
  return {
      z_up ? UpAxis::kZ : UpAxis::kY,
      fmt::format("the body stands along it with {:.2f} of its length on average and its lowest "
                  "joint keeps its height within {:.2f} body heights",
                  direction[axis], (floor_high[axis] - floor_low[axis]) / std::max(height, 1e-12))};
}

bool RestPoseStandsAlongZ(const std::vector<Joint>& joints) {
  std::vector<Vec3> positions;
  WalkRestPose(joints, positions);
  const Vec3 direction = BodyEnds(joints).Direction(positions);
  return direction.z() > 0.5 && direction.z() > direction.y();
}

double RateOfFrameTime(double seconds, std::string_view written) {
  constexpr std::array kUsualRates = {24.0,  25.0,  30.0,  48.0,  50.0,  60.0,  72.0,  75.0, 90.0,
                                      100.0, 120.0, 144.0, 150.0, 200.0, 240.0, 250.0, 300.0};
  constexpr double kMostChange = 5e-3;
  const double rate = 1 / seconds;
  const size_t point = written.find('.');
  const bool has_exponent = written.find_first_of("eE") != std::string_view::npos;
  if (point == std::string_view::npos || has_exponent || !std::isfinite(rate)) return rate;
  const double rounding = 0.5001 * std::pow(10.0, -static_cast<double>(written.size() - point - 1));
  const auto agrees = [&](double candidate) {
    return candidate > 0 && std::abs(1 / candidate - seconds) <= rounding &&
           std::abs(candidate - rate) <= kMostChange * rate;
  };
  for (const double usual : kUsualRates) {
    if (agrees(usual)) return usual;
  }
  return agrees(std::round(rate)) ? std::round(rate) : rate;
}

}  // namespace poise::motion
