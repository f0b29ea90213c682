#include "core/motion/io/raw_clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/motion/io/convention_detection.h"
#include "core/motion/io/text_scanner.h"

namespace poise::motion {
namespace {

// 31 joints at 120 Hz for more than an hour; half a gigabyte in memory.
constexpr int64_t kMostRotations = int64_t{1} << 24;

// A motion's name is its file's, without folder and ending.
std::string ClipName(std::string_view file) {
  file = file.substr(file.find_last_of("/\\") + 1);
  const size_t dot = file.rfind('.');
  return ToUtf8(dot == 0 || dot == std::string_view::npos ? file : file.substr(0, dot));
}

// Turns a motion with Z up so that Y is up.
void TurnUpright(RawClip& raw, bool turn_rest_pose) {
  const double half = std::numbers::sqrt2 / 2;
  const Quat turn(half, -half, 0, 0);  // -90 degrees about X
  for (Vec3& position : raw.root_positions) position = {position.x(), position.z(), -position.y()};
  const size_t joints = raw.joints.size();
  if (!turn_rest_pose) {
    for (size_t i = 0; i < raw.rotations.size(); i += joints) {
      raw.rotations[i] = turn * raw.rotations[i];
    }
    return;
  }
  // turn * q * turn^-1 only turns q's axis.
  for (Quat& q : raw.rotations) q = Quat(q.w(), q.x(), q.z(), -q.y());
  for (Joint& joint : raw.joints) {
    joint.offset = {joint.offset.x(), joint.offset.z(), -joint.offset.y()};
    if (joint.end_site) {
      joint.end_site = Vec3(joint.end_site->x(), joint.end_site->z(), -joint.end_site->y());
    }
  }
}

void Scale(RawClip& raw, double unit_m) {
  for (Vec3& position : raw.root_positions) position *= unit_m;
  for (Joint& joint : raw.joints) {
    joint.offset *= unit_m;
    if (joint.end_site) *joint.end_site *= unit_m;
  }
}

template <typename T, typename Detect>
RawClip::Stated<T> Choose(const std::optional<T>& hint,
                          const std::optional<RawClip::Stated<T>>& stated, Detect detect) {
  if (hint) return {*hint, "as asked"};
  return stated ? *stated : detect();
}

Status CheckHints(std::string_view file, const ClipHints& hints) {
  const auto check = [&](const std::optional<double>& value, const char* name) -> Status {
    if (!value || (std::isfinite(*value) && *value > 0)) return absl::OkStatus();
    return base::InvalidArgument(
        "BAD_HINT", name,
        fmt::format("{}: the given {} is {}, expected a positive number", file, name, *value));
  };
  POISE_RETURN_IF_ERROR(check(hints.unit_m, "unit_m"));
  return check(hints.frame_rate, "frame_rate");
}

}  // namespace

int64_t MostRotations(size_t file_bytes) {
  constexpr int64_t kAlwaysAllowed = int64_t{1} << 18;
  return std::min(kMostRotations, std::max(kAlwaysAllowed, 4 * static_cast<int64_t>(file_bytes)));
}

Status CheckSize(std::string_view file, int line, int64_t frames, int64_t joints,
                 size_t file_bytes) {
  const int64_t most = MostRotations(file_bytes);
  if (frames <= most / std::max<int64_t>(joints, 1)) return absl::OkStatus();
  return base::InvalidArgument(
      "TOO_LARGE", "",
      fmt::format(
          "{}: {}{} frames x {} joints, expected at most {} rotations in a file of {} bytes", file,
          line > 0 ? fmt::format("line {}: ", line) : "", frames, joints, most, file_bytes));
}

StatusOr<ClipFile> ToClipFile(std::string_view file, RawClip raw, ClipFormat format,
                              const ClipHints& hints) {
  POISE_RETURN_IF_ERROR(CheckHints(file, hints));
  const auto unit = Choose(hints.unit_m, raw.unit_m, [&] { return DetectUnit(raw.joints); });
  const auto up = Choose(hints.up, raw.up, [&] { return DetectUpAxis(raw); });
  SourceConvention convention;
  convention.format = format;
  convention.unit_m = unit.value;
  convention.up = up.value;
  convention.rest_pose_turned = up.value == UpAxis::kZ && RestPoseStandsAlongZ(raw.joints);
  convention.channels = std::move(raw.channels);
  const double rate = hints.frame_rate.value_or(raw.frame_rate.value);
  convention.notes = {
      fmt::format("unit: {:.6g} m, {}", unit.value, unit.why),
      fmt::format("up: {}, {}{}", up.value == UpAxis::kZ ? "Z" : "Y", up.why,
                  up.value == UpAxis::kY        ? ""
                  : convention.rest_pose_turned ? "; turned to Y with its rest pose"
                                                : "; turned to Y at the root only"),
      fmt::format("rate: {:.6g} Hz, {}", rate, hints.frame_rate ? "as asked" : raw.frame_rate.why)};
  convention.notes.insert(convention.notes.end(), raw.notes.begin(), raw.notes.end());

  if (up.value == UpAxis::kZ) TurnUpright(raw, convention.rest_pose_turned);
  Scale(raw, unit.value);
  auto skeleton = Skeleton::Create(std::move(raw.joints));
  if (!skeleton.ok()) return base::Annotate(skeleton.status(), std::string(file));
  auto clip = Clip::Create(ClipName(file), *std::move(skeleton), rate,
                           std::move(raw.root_positions), std::move(raw.rotations));
  if (!clip.ok()) return base::Annotate(clip.status(), std::string(file));
  return ClipFile{*std::move(clip), std::move(convention)};
}

}  // namespace poise::motion
