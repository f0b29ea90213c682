#ifndef POISE_PROTO_CONVERT_CLIP_CONVERT_H_
#define POISE_PROTO_CONVERT_CLIP_CONVERT_H_

#include "core/api/clip_source.h"
#include "core/base/status.h"
#include "core/motion/clip.h"
#include "poise/v1/clip.pb.h"

/// Motions between the wire and memory. FromProto trusts nothing: sizes are compared before memory
/// is taken, and errors name the field below the message ("skeleton.joints[3].parent").
namespace poise::convert {

v1::Vector3 ToProto(const motion::Vec3& vector);
motion::Vec3 FromProto(const v1::Vector3& vector);

v1::Skeleton ToProto(const motion::Skeleton& skeleton);
/// Errors: those of Skeleton::Create.
StatusOr<motion::SkeletonPtr> FromProto(const v1::Skeleton& skeleton);

/// The arrays of a clip, which several messages hold: root_positions (frames, 3), rotations
/// (frames, joints, 4) w x y z. Numbers lose their last bits: single precision on the wire.
using FloatArray = google::protobuf::RepeatedField<float>;
void WriteArrays(const motion::Clip& clip, FloatArray& root_positions, FloatArray& rotations);

/// What the arrays do not say.
struct ArraysOf {
  std::string name;
  motion::SkeletonPtr skeleton;
  double frame_rate = 0;
};
/// Errors: kInvalidArgument WRONG_SHAPE, those of Clip::Create.
StatusOr<motion::Clip> ReadArrays(ArraysOf clip, const FloatArray& root_positions,
                                  const FloatArray& rotation_numbers);

v1::Clip ToProto(const motion::Clip& clip);
/// Errors: kInvalidArgument WRONG_SHAPE, those of Skeleton::Create and Clip::Create.
StatusOr<motion::Clip> FromProto(const v1::Clip& clip);

v1::ClipFormat ToProto(motion::ClipFormat format);
/// Errors: kInvalidArgument UNKNOWN_FORMAT.
StatusOr<motion::ClipFormat> FromProto(v1::ClipFormat format);

v1::ClipHints ToProto(const motion::ClipHints& hints);
/// Errors: kInvalidArgument BAD_HINT.
StatusOr<motion::ClipHints> FromProto(const v1::ClipHints& hints);

v1::EncodedClip ToProto(const api::EncodedClip& file);
/// Errors: those of the format and the hints.
StatusOr<api::EncodedClip> FromProto(const v1::EncodedClip& file);

v1::StoredClip ToProto(const api::StoredClip& stored);
/// Errors: those of the format and the hints. The artifact's name is checked by the store.
StatusOr<api::StoredClip> FromProto(const v1::StoredClip& stored);

v1::ClipSource ToProto(const api::ClipSource& source);
/// Errors: kInvalidArgument EMPTY_SOURCE, and those of what it holds.
StatusOr<api::ClipSource> FromProto(const v1::ClipSource& source);

}  // namespace poise::convert

#endif  // POISE_PROTO_CONVERT_CLIP_CONVERT_H_
