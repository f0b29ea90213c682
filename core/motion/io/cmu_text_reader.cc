#include "core/motion/io/cmu_text_reader.h"

#include <fmt/format.h>

#include <array>
#include <limits>

#include "core/motion/io/text_scanner.h"

namespace poise::motion {
namespace {

constexpr double kCmuUnit = 0.0254 / 0.45;  // [m]
constexpr double kCmuFrameRate = 120;       // [Hz]
// Between a T-pose and the first pose of a motion a shoulder turns by 1 to 2 rad; in 1/120 s none
// turns by half of it.
constexpr double kJump = 0.8;  // [rad]

// Order and parents of the usual CMU conversion; offsets of one reference skeleton, CMU units.
// A node without a name is the tip of its parent's bone.
struct Node {
  const char* name;
  int parent;
  double x, y, z;
};
constexpr std::array<Node, 38> kNodes = {{
    {"Hips", -1, 0, 0, 0},
    {"LHipJoint", 0, 0, 0, 0},
    {"LeftUpLeg", 1, 1.65674, -1.80282, 0.62477},
    {"LeftLeg", 2, 2.5972, -7.13576, 0},
    {"LeftFoot", 3, 2.49236, -6.8477, 0},
    {"LeftToeBase", 4, 0.19704, -0.54136, 2.14581},
    {nullptr, 5, 0, 0, 1.11249},
    {"RHipJoint", 0, 0, 0, 0},
    {"RightUpLeg", 7, -1.6107, -1.80282, 0.62476},
    {"RightLeg", 8, -2.59502, -7.12977, 0},
    {"RightFoot", 9, -2.4678, -6.78024, 0},
    {"RightToeBase", 10, -0.23024, -0.63258, 2.13368},
    {nullptr, 11, 0, 0, 1.11569},
    {"LowerBack", 0, 0, 0, 0},
    {"Spine", 13, 0.01961, 2.0545, -0.14112},
    {"Spine1", 14, 0.01021, 2.06436, -0.05921},
    {"Neck", 15, 0, 0, 0},
    {"Neck1", 16, 0.00713, 1.56711, 0.14968},
    {"Head", 17, 0.03429, 1.56041, -0.10006},
    {nullptr, 18, 0.01305, 1.6256, -0.05265},
    {"LeftShoulder", 15, 0, 0, 0},
    {"LeftArm", 20, 3.54205, 0.90436, -0.17364},
    {"LeftForeArm", 21, 4.86513, 0, 0},
    {"LeftHand", 22, 3.35554, 0, 0},
    {"LeftFingerBase", 23, 0, 0, 0},
    {"LeftHandIndex1", 24, 0.66117, 0, 0},
    {nullptr, 25, 0.53306, 0, 0},
    {"LThumb", 23, 0, 0, 0},
    {nullptr, 27, 0.5412, 0, 0.5412},
    {"RightShoulder", 15, 0, 0, 0},
    {"RightArm", 29, -3.49802, 0.75994, -0.32616},
    {"RightForeArm", 30, -5.02649, 0, 0},
    {"RightHand", 31, -3.36431, 0, 0},
    {"RightFingerBase", 32, 0, 0, 0},
    {"RightHandIndex1", 33, -0.73041, 0, 0},
    {nullptr, 34, -0.58887, 0, 0},
    {"RThumb", 32, 0, 0, 0},
    {nullptr, 36, -0.59786, 0, 0.59786},
}};
static_assert(3 + 3 * kNodes.size() == kCmuTextColumns);

std::vector<Joint> ReferenceJoints() {
  std::vector<Joint> joints;
  std::array<int, kNodes.size()> joint_of_node{};
  for (size_t i = 0; i < kNodes.size(); ++i) {
    const Node& node = kNodes[i];
    const int parent = node.parent < 0 ? -1 : joint_of_node[node.parent];
    const Vec3 offset(node.x, node.y, node.z);
    if (node.name == nullptr) {
      joints[parent].end_site = offset;
      continue;
    }
    joint_of_node[i] = static_cast<int>(joints.size());
    joints.push_back({node.name, parent, offset, std::nullopt});
  }
  return joints;
}

// Names the joint that turns most between the first two frames if no body moves so fast.
void NoteJumpAfterFirstFrame(RawClip& clip) {
  const size_t joints = clip.joints.size();
  if (clip.root_positions.size() < 2) return;
  size_t fastest = 0;
  double most = 0;
  for (size_t joint = 0; joint < joints; ++joint) {
    const double angle =
        math::GeodesicDistance(clip.rotations[joint], clip.rotations[joints + joint]);
    if (angle > most) {
      most = angle;
      fastest = joint;
    }
  }
  if (most < kJump) return;
  clip.notes.push_back(
      fmt::format("frame 0 is a T-pose and no part of the motion ({} turns by {:.2f} rad to frame "
                  "1): kept, drop it for anything with velocities",
                  clip.joints[fastest].name, most));
}

}  // namespace

StatusOr<RawClip> ReadCmuText(std::string_view file, std::string_view data) {
  TextScanner scanner(file, "MALFORMED_CMU_TEXT", data);
  RawClip clip;
  clip.joints = ReferenceJoints();
  std::array<double, kCmuTextColumns> row;
  while (scanner.NextLine()) {
    const size_t frame = clip.root_positions.size();
    POISE_RETURN_IF_ERROR(scanner.ReadRow(row, fmt::format("frame {}", frame), ','));
    POISE_RETURN_IF_ERROR(CheckSize(file, scanner.line_number(), frame + 1, clip.joints.size(),
                                    std::numeric_limits<uint32_t>::max()));
    clip.root_positions.emplace_back(row[0], row[1], row[2]);
    for (size_t node = 0; node < kNodes.size(); ++node) {
      if (kNodes[node].name == nullptr) continue;
      const double* vector = &row[3 + 3 * node];
      clip.rotations.push_back(math::FromRotationVector(-Vec3(vector[0], vector[1], vector[2])));
    }
  }
  if (clip.root_positions.empty()) {
    return scanner.Expected(fmt::format("lines of {} numbers", kCmuTextColumns), "");
  }
  clip.unit_m = {kCmuUnit, "the unit of CMU's recordings"};
  clip.up = {UpAxis::kY, "as in all files of this format"};
  clip.frame_rate = {kCmuFrameRate, "at which CMU recorded; the file does not say"};
  clip.notes.push_back("bones: one reference skeleton, the file has no lengths");
  NoteJumpAfterFirstFrame(clip);
  return clip;
}

}  // namespace poise::motion
