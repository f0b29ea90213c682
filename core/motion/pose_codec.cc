#include "core/motion/pose_codec.h"

#include <fmt/format.h>

namespace poise::motion {
namespace {

using enum RotationRepresentation;
using RowMajorMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// Writes one rotation to out[0 .. width). `before` points at the same joint's numbers in the frame
// before, or is null.
void EncodeRotation(const Quat& rotation, const RotationCodec& codec, const double* before,
                    double* out) {
  Eigen::Map<Vec3> three(out);
  switch (codec.representation) {
    case kQuaternion: {
      Eigen::Map<Eigen::Vector4d> wxyz(out);
      wxyz << rotation.w(), rotation.vec();
      const double sign = before ? Eigen::Map<const Eigen::Vector4d>(before).dot(wxyz) : wxyz[0];
      if (sign < 0) wxyz = -wxyz;
      break;
    }
    case kMatrix:
      Eigen::Map<RowMajorMat3>{out} = rotation.toRotationMatrix();
      break;
    case kSixD:
      Eigen::Map<math::Vec6>{out} = math::ToSixD(rotation);
      break;
    case kExponentialMap:
      three = math::ToRotationVector(rotation);
      if (before) three = math::UnwrapRotationVector(three, Eigen::Map<const Vec3>(before));
      break;
    case kEuler:
      three = math::ToEuler(rotation, codec.euler_order);
      break;
  }
}

StatusOr<Quat> DecodeRotation(const double* in, const RotationCodec& codec) {
  if (!Eigen::Map<const Eigen::VectorXd>(in, codec.width()).allFinite()) {
    return base::InvalidArgument("NOT_FINITE", "poses", "rotation is not finite");
  }
  switch (codec.representation) {
    case kQuaternion: {
      const Quat rotation(in[0], in[1], in[2], in[3]);
      if (std::abs(rotation.norm() - 1) > 1e-2) {
        return base::InvalidArgument(
            "NOT_A_ROTATION", "poses",
            fmt::format("quaternion has length {}, expected 1", rotation.norm()));
      }
      return rotation;
    }
    case kMatrix:
      return math::FromMatrix(Eigen::Map<const RowMajorMat3>(in));
    case kSixD:
      return math::FromSixD(Eigen::Map<const math::Vec6>(in));
    case kExponentialMap:
      return math::FromRotationVector(Eigen::Map<const Vec3>(in));
    case kEuler:
      break;
  }
  return math::FromEuler(Eigen::Map<const Vec3>(in), codec.euler_order);
}

}  // namespace

int RotationCodec::width() const {
  switch (representation) {
    case kQuaternion:
      return 4;
    case kMatrix:
      return 9;
    case kSixD:
      return 6;
    case kExponentialMap:
    case kEuler:
      break;
  }
  return 3;
}

PoseMatrix EncodePoses(const Clip& clip, const RotationCodec& codec, bool with_root_position) {
  const int first = with_root_position ? 3 : 0;
  const int width = codec.width();
  PoseMatrix poses(clip.num_frames(), first + clip.num_joints() * width);
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    if (with_root_position) poses.row(frame).head<3>() = clip.root_position(frame);
    for (int joint = 0; joint < clip.num_joints(); ++joint) {
      const int column = first + joint * width;
      EncodeRotation(clip.rotation(frame, joint), codec,
                     frame == 0 ? nullptr : &poses(frame - 1, column), &poses(frame, column));
    }
  }
  return poses;
}

StatusOr<Clip> DecodePoses(const PoseMatrix& poses, const RotationCodec& codec, std::string name,
                           SkeletonPtr skeleton, double frame_rate, bool with_root_position) {
  const int first = with_root_position ? 3 : 0;
  const int joints = skeleton->num_joints();
  const int width = codec.width();
  if (poses.cols() != first + joints * width) {
    return base::InvalidArgument(
        "WRONG_SHAPE", "poses",
        fmt::format(
            "clip '{}': rows have {} columns, expected {} for the root + {} joints x {} = {}", name,
            poses.cols(), first, joints, width, first + joints * width));
  }
  std::vector<Vec3> positions(poses.rows(), Vec3::Zero());
  std::vector<Quat> rotations;
  rotations.reserve(poses.rows() * joints);
  for (int frame = 0; frame < poses.rows(); ++frame) {
    if (with_root_position) positions[frame] = poses.row(frame).head<3>();
    for (int joint = 0; joint < joints; ++joint) {
      auto rotation = DecodeRotation(&poses(frame, first + joint * width), codec);
      if (!rotation.ok()) {
        return base::Annotate(rotation.status(),
                              fmt::format("clip '{}': frame {}, joint '{}'", name, frame,
                                          skeleton->joint(joint).name));
      }
      rotations.push_back(*rotation);
    }
  }
  return Clip::Create(std::move(name), std::move(skeleton), frame_rate, std::move(positions),
                      std::move(rotations));
}

}  // namespace poise::motion
