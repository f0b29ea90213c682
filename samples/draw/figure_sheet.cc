#include "samples/draw/figure_sheet.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/motion/joint_roles.h"
#include "core/motion/kinematics/forward_kinematics.h"

namespace poise::samples {
namespace {

using motion::Clip;
using motion::JointRole;
using motion::JointRoles;
using motion::Vec3;
using motion::WorldPoses;
using enum motion::JointRole;

constexpr double kPixelsPerMetre = 100;
constexpr double kCellWidth = 1.45;   // [m]
constexpr double kCellHeight = 1.95;  // [m]
constexpr double kGround = 1.88;      // [m] below the cell's top

constexpr const char* kTrunk = "#8d8f96";
constexpr const char* kRight = "#cd553c";
constexpr const char* kLeft = "#4678c8";

struct Bone {
  JointRole from, to;
  double width;  // [m]
  const char* colour;
};

constexpr Bone kBones[] = {
    {kPelvis, kSpine, 0.21, kTrunk},
    {kSpine, kChest, 0.22, kTrunk},
    {kChest, kNeck, 0.20, kTrunk},
    {kNeck, kHead, 0.10, kTrunk},
    {kLeftHip, kLeftKnee, 0.13, kLeft},
    {kLeftKnee, kLeftAnkle, 0.09, kLeft},
    {kLeftAnkle, kLeftToe, 0.06, kLeft},
    {kLeftShoulder, kLeftElbow, 0.085, kLeft},
    {kLeftElbow, kLeftWrist, 0.065, kLeft},
    {kRightHip, kRightKnee, 0.13, kRight},
    {kRightKnee, kRightAnkle, 0.09, kRight},
    {kRightAnkle, kRightToe, 0.06, kRight},
    {kRightShoulder, kRightElbow, 0.085, kRight},
    {kRightElbow, kRightWrist, 0.065, kRight},
};

// The side view: x ahead, y up, z towards the viewer at the performer's right.
struct View {
  Vec3 ahead, right;

  // As the hips face on average.
  View(const WorldPoses& poses, const JointRoles& roles) {
    right = Vec3::Zero();
    for (int frame = 0; frame < poses.num_frames; ++frame) {
      right += poses.position(frame, roles.joint(kRightHip)) -
               poses.position(frame, roles.joint(kLeftHip));
    }
    right = Vec3(right.x(), 0, right.z()).normalized();
    ahead = Vec3::UnitY().cross(right);
  }
  Vec3 operator()(const Vec3& p) const { return Vec3(ahead.dot(p), p.y(), right.dot(p)); }
};

// One clip, ready to draw.
struct Actor {
  WorldPoses poses;
  JointRoles roles;
  View view;

  explicit Actor(const Clip& clip, JointRoles found)
      : poses(motion::ForwardKinematics(clip)), roles(std::move(found)), view(poses, roles) {}
  Vec3 At(int frame, JointRole role) const {
    return view(poses.position(frame, roles.joint(role)));
  }
};

// Far limbs first, so that near ones cover them.
void DrawFigure(const Actor& actor, int frame, double centre_x, double ground_y, double opacity,
                std::string& svg) {
  const double middle = actor.At(frame, kPelvis).x();
  const auto x = [&](const Vec3& p) { return centre_x + (p.x() - middle) * kPixelsPerMetre; };
  const auto y = [&](const Vec3& p) { return ground_y - p.y() * kPixelsPerMetre; };
  std::vector<std::pair<double, std::string>> parts;
  for (const Bone& bone : kBones) {
    if (!actor.roles.has(bone.from) || !actor.roles.has(bone.to)) continue;
    const Vec3 a = actor.At(frame, bone.from), b = actor.At(frame, bone.to);
    parts.emplace_back(
        (a + b).z(),
        fmt::format("<path d='M{:.1f} {:.1f}L{:.1f} {:.1f}' stroke='{}' stroke-width='{:.1f}'/>\n",
                    x(a), y(a), x(b), y(b), bone.colour, bone.width * kPixelsPerMetre));
  }
  if (actor.roles.has(kHead)) {
    const Vec3 neck = actor.At(frame, kNeck), head = actor.At(frame, kHead);
    const Vec3 centre = head + 0.08 * (head - neck).normalized();
    parts.emplace_back(2 * head.z(), fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{:.1f}' "
                                                 "fill='#e0bfa0'/>\n",
                                                 x(centre), y(centre), 0.10 * kPixelsPerMetre));
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  svg += fmt::format("<g opacity='{}'>\n", opacity);
  for (const auto& [depth, part] : parts) svg += part;
  svg += "</g>\n";
}

}  // namespace

StatusOr<std::string> DrawSheet(const std::vector<Clip>& clips, const SheetLayout& layout) {
  if (clips.empty() || layout.moments < 1) {
    return base::InvalidArgument("EMPTY_SHEET", "", "a sheet needs a clip and a moment");
  }
  const int rows = layout.overlay ? 1 : static_cast<int>(clips.size());
  const double width = kCellWidth * kPixelsPerMetre * layout.moments;
  const double height = kCellHeight * kPixelsPerMetre * rows;
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0} {1}' fill='none' "
      "stroke-linecap='round' font-family='sans-serif' font-size='13'>\n"
      "<rect width='{0}' height='{1}' fill='#fafaf8'/>\n",
      width, height);
  for (size_t i = 0; i < clips.size(); ++i) {
    POISE_ASSIGN_OR_RETURN(JointRoles roles, JointRoles::Detect(*clips[i].skeleton()));
    POISE_RETURN_IF_ERROR(roles.RequireComplete());
    const Actor actor(clips[i], std::move(roles));
    const double top = layout.overlay ? 0 : i * kCellHeight * kPixelsPerMetre;
    const double ground = top + kGround * kPixelsPerMetre;
    svg += fmt::format("<path d='M0 {0:.1f}H{1}' stroke='#555'/>\n", ground, width);
    for (int k = 0; k < layout.moments; ++k) {
      const int last = clips[i].num_frames() - 1;
      const int frame = layout.moments == 1 ? last / 2 : last * k / (layout.moments - 1);
      DrawFigure(actor, frame, (k + 0.5) * kCellWidth * kPixelsPerMetre, ground,
                 layout.overlay && clips.size() > 1 ? 0.35 : 1, svg);
      if (i > 0 && layout.overlay) continue;
      svg += fmt::format("<text x='{:.1f}' y='{:.1f}' fill='#333'>{}{:.2f} s</text>\n",
                         k * kCellWidth * kPixelsPerMetre + 6, top + 16,
                         k == 0 && !layout.overlay ? clips[i].name() + " " : "",
                         frame / clips[i].frame_rate());
    }
  }
  return svg + "</svg>\n";
}

}  // namespace poise::samples
