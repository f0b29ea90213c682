#include "proto/convert/clip_convert.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "proto/convert/utf8.h"

namespace poise::convert {
namespace {

using motion::Quat;
using motion::Vec3;

Status WrongShape(const std::string& clip, const char* field, int64_t got,
                  const std::string& expected) {
  return base::InvalidArgument(
      "WRONG_SHAPE", field,
      fmt::format("clip '{}': {} has {} numbers, expected {}", clip, field, got, expected));
}

// Room for `count` more numbers, which the caller writes.
float* Append(size_t count, FloatArray& numbers) {
  numbers.Reserve(numbers.size() + static_cast<int>(count));
  return numbers.AddNAlreadyReserved(static_cast<int>(count));
}

// Fields that EncodedClip and StoredClip share.
template <typename Message, typename Value>
Status ReadFileFields(const Message& message, Value& value) {
  POISE_ASSIGN_OR_RETURN(value.format, FromProto(message.format()));
  StatusOr<motion::ClipHints> hints = FromProto(message.hints());
  if (!hints.ok()) return base::Annotate(hints.status(), "hints", "hints");
  value.hints = *hints;
  value.name = message.name();
  value.skeleton_data = message.skeleton_data();
  return absl::OkStatus();
}

template <typename Value, typename Message>
void WriteFileFields(const Value& value, Message& message) {
  message.set_format(ToProto(value.format));
  *message.mutable_hints() = ToProto(value.hints);
  message.set_name(ValidUtf8(value.name));
  message.set_skeleton_data(value.skeleton_data);
}

}  // namespace

v1::Vector3 ToProto(const Vec3& vector) {
  v1::Vector3 message;
  message.set_x(vector.x());
  message.set_y(vector.y());
  message.set_z(vector.z());
  return message;
}

Vec3 FromProto(const v1::Vector3& vector) { return Vec3(vector.x(), vector.y(), vector.z()); }

v1::Skeleton ToProto(const motion::Skeleton& skeleton) {
  v1::Skeleton message;
  for (const motion::Joint& joint : skeleton.joints()) {
    v1::Joint* added = message.add_joints();
    added->set_name(ValidUtf8(joint.name));
    added->set_parent(joint.parent);
    *added->mutable_offset() = ToProto(joint.offset);
    if (joint.end_site) *added->mutable_end_site() = ToProto(*joint.end_site);
  }
  return message;
}

StatusOr<motion::SkeletonPtr> FromProto(const v1::Skeleton& skeleton) {
  if (skeleton.joints_size() > motion::Skeleton::kMaxJoints) {
    return base::InvalidArgument("TOO_MANY_JOINTS", "skeleton.joints",
                                 fmt::format("skeleton has {} joints, at most {}",
                                             skeleton.joints_size(), motion::Skeleton::kMaxJoints));
  }
  std::vector<motion::Joint> joints;
  joints.reserve(skeleton.joints_size());
  for (const v1::Joint& joint : skeleton.joints()) {
    joints.push_back({joint.name(), joint.parent(), FromProto(joint.offset()), {}});
    if (joint.has_end_site()) joints.back().end_site = FromProto(joint.end_site());
  }
  return motion::Skeleton::Create(std::move(joints));
}

void WriteArrays(const motion::Clip& clip, FloatArray& root_positions, FloatArray& rotations) {
  float* position = Append(3 * clip.root_positions().size(), root_positions);
  for (const Vec3& value : clip.root_positions()) {
    for (int axis = 0; axis < 3; ++axis) *position++ = static_cast<float>(value[axis]);
  }
  float* rotation = Append(4 * clip.rotations().size(), rotations);
  for (const Quat& value : clip.rotations()) {
    *rotation++ = static_cast<float>(value.w());
    *rotation++ = static_cast<float>(value.x());
    *rotation++ = static_cast<float>(value.y());
    *rotation++ = static_cast<float>(value.z());
  }
}

v1::Clip ToProto(const motion::Clip& clip) {
  v1::Clip message;
  message.set_name(ValidUtf8(clip.name()));
  *message.mutable_skeleton() = ToProto(*clip.skeleton());
  message.set_frame_rate(clip.frame_rate());
  WriteArrays(clip, *message.mutable_root_positions(), *message.mutable_rotations());
  return message;
}

StatusOr<motion::Clip> ReadArrays(ArraysOf clip, const FloatArray& root_positions,
                                  const FloatArray& rotation_numbers) {
  if (root_positions.size() % 3 != 0) {
    return WrongShape(clip.name, "root_positions", root_positions.size(), "frames x 3");
  }
  const int64_t frames = root_positions.size() / 3;
  const int64_t joints = clip.skeleton->num_joints();
  if (rotation_numbers.size() != frames * joints * 4) {
    return WrongShape(
        clip.name, "rotations", rotation_numbers.size(),
        fmt::format("{} frames x {} joints x 4 = {}", frames, joints, frames * joints * 4));
  }
  std::vector<Vec3> positions(frames);
  const float* position = root_positions.data();
  for (Vec3& value : positions) {
    value = Vec3(position[0], position[1], position[2]);
    position += 3;
  }
  std::vector<Quat> rotations(frames * joints);
  const float* rotation = rotation_numbers.data();
  for (Quat& value : rotations) {
    value = Quat(rotation[0], rotation[1], rotation[2], rotation[3]);
    rotation += 4;
  }
  return motion::Clip::Create(std::move(clip.name), std::move(clip.skeleton), clip.frame_rate,
                              std::move(positions), std::move(rotations));
}

StatusOr<motion::Clip> FromProto(const v1::Clip& clip) {
  StatusOr<motion::SkeletonPtr> skeleton = FromProto(clip.skeleton());
  if (!skeleton.ok()) {
    return base::Annotate(skeleton.status(), fmt::format("clip '{}'", clip.name()));
  }
  return ReadArrays({clip.name(), *std::move(skeleton), clip.frame_rate()}, clip.root_positions(),
                    clip.rotations());
}

v1::ClipFormat ToProto(motion::ClipFormat format) {
  switch (format) {
    case motion::ClipFormat::kBvh:
      return v1::CLIP_FORMAT_BVH;
    case motion::ClipFormat::kAmc:
      return v1::CLIP_FORMAT_AMC;
    case motion::ClipFormat::kNpz:
      return v1::CLIP_FORMAT_NPZ;
    case motion::ClipFormat::kCmuText:
      return v1::CLIP_FORMAT_CMU_TEXT;
    case motion::ClipFormat::kDeepMimic:
      return v1::CLIP_FORMAT_DEEPMIMIC;
    case motion::ClipFormat::kUnknown:
      break;
  }
  return v1::CLIP_FORMAT_UNSPECIFIED;
}

StatusOr<motion::ClipFormat> FromProto(v1::ClipFormat format) {
  switch (format) {
    case v1::CLIP_FORMAT_UNSPECIFIED:
      return motion::ClipFormat::kUnknown;
    case v1::CLIP_FORMAT_BVH:
      return motion::ClipFormat::kBvh;
    case v1::CLIP_FORMAT_AMC:
      return motion::ClipFormat::kAmc;
    case v1::CLIP_FORMAT_NPZ:
      return motion::ClipFormat::kNpz;
    case v1::CLIP_FORMAT_CMU_TEXT:
      return motion::ClipFormat::kCmuText;
    case v1::CLIP_FORMAT_DEEPMIMIC:
      return motion::ClipFormat::kDeepMimic;
    default:
      return base::InvalidArgument(
          "UNKNOWN_FORMAT", "format",
          fmt::format("clip format {} is not known to this server", static_cast<int>(format)));
  }
}

v1::ClipHints ToProto(const motion::ClipHints& hints) {
  v1::ClipHints message;
  if (hints.unit_m) message.set_unit_m(*hints.unit_m);
  if (hints.up) message.set_up(*hints.up == motion::UpAxis::kY ? v1::UP_AXIS_Y : v1::UP_AXIS_Z);
  if (hints.frame_rate) message.set_frame_rate(*hints.frame_rate);
  return message;
}

StatusOr<motion::ClipHints> FromProto(const v1::ClipHints& hints) {
  motion::ClipHints value;
  if (hints.has_unit_m()) {
    value.unit_m = hints.unit_m();
    if (!(*value.unit_m > 0 && std::isfinite(*value.unit_m))) {
      return base::InvalidArgument("BAD_HINT", "unit_m",
                                   fmt::format("unit_m is {}, expected > 0", *value.unit_m));
    }
  }
  if (hints.has_frame_rate()) {
    value.frame_rate = hints.frame_rate();
    if (!(*value.frame_rate > 0 && *value.frame_rate <= motion::Clip::kMaxFrameRate)) {
      return base::InvalidArgument("BAD_HINT", "frame_rate",
                                   fmt::format("frame_rate is {}, expected (0, {}] Hz",
                                               *value.frame_rate, motion::Clip::kMaxFrameRate));
    }
  }
  switch (hints.up()) {
    case v1::UP_AXIS_UNSPECIFIED:
      return value;
    case v1::UP_AXIS_Y:
      value.up = motion::UpAxis::kY;
      return value;
    case v1::UP_AXIS_Z:
      value.up = motion::UpAxis::kZ;
      return value;
    default:
      return base::InvalidArgument(
          "BAD_HINT", "up",
          fmt::format("up axis {} is not known to this server", static_cast<int>(hints.up())));
  }
}

v1::EncodedClip ToProto(const api::EncodedClip& file) {
  v1::EncodedClip message;
  WriteFileFields(file, message);
  message.set_data(file.data);
  return message;
}

StatusOr<api::EncodedClip> FromProto(const v1::EncodedClip& file) {
  api::EncodedClip value;
  POISE_RETURN_IF_ERROR(ReadFileFields(file, value));
  value.data = file.data();
  return value;
}

v1::StoredClip ToProto(const api::StoredClip& stored) {
  v1::StoredClip message;
  WriteFileFields(stored, message);
  message.set_artifact(ValidUtf8(stored.artifact));
  return message;
}

StatusOr<api::StoredClip> FromProto(const v1::StoredClip& stored) {
  api::StoredClip value;
  POISE_RETURN_IF_ERROR(ReadFileFields(stored, value));
  value.artifact = stored.artifact();
  return value;
}

v1::ClipSource ToProto(const api::ClipSource& source) {
  v1::ClipSource message;
  if (const auto* clip = std::get_if<motion::Clip>(&source.clip)) {
    *message.mutable_clip() = ToProto(*clip);
  } else if (const auto* file = std::get_if<api::EncodedClip>(&source.clip)) {
    *message.mutable_file() = ToProto(*file);
  } else {
    *message.mutable_stored() = ToProto(std::get<api::StoredClip>(source.clip));
  }
  message.mutable_joint_roles()->insert(source.joint_roles.begin(), source.joint_roles.end());
  return message;
}

StatusOr<api::ClipSource> FromProto(const v1::ClipSource& source) {
  const motion::RoleOverrides roles(source.joint_roles().begin(), source.joint_roles().end());
  const auto with_roles = [&](auto value, const char* field) -> StatusOr<api::ClipSource> {
    if (!value.ok()) return base::Annotate(value.status(), field, field);
    return api::ClipSource{*std::move(value), roles};
  };
  switch (source.source_case()) {
    case v1::ClipSource::kClip:
      return with_roles(FromProto(source.clip()), "clip");
    case v1::ClipSource::kFile:
      return with_roles(FromProto(source.file()), "file");
    case v1::ClipSource::kStored:
      return with_roles(FromProto(source.stored()), "stored");
    case v1::ClipSource::SOURCE_NOT_SET:
      break;
  }
  return base::InvalidArgument("EMPTY_SOURCE", "source",
                               "source is empty, expected a clip, a file or a stored file");
}

}  // namespace poise::convert
