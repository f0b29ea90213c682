#ifndef POISE_CORE_MOTION_POSE_CODEC_H_
#define POISE_CORE_MOTION_POSE_CODEC_H_

#include <Eigen/Core>
#include <string>

#include "core/motion/clip.h"

/// Clips as plain numbers, for networks, metrics and array formats.
namespace poise::motion {

enum class RotationRepresentation { kQuaternion, kMatrix, kSixD, kExponentialMap, kEuler };

/// How one joint's rotation becomes `width()` numbers:
///   kQuaternion      4  w x y z; the sign that is nearest to the frame before (w >= 0 at first)
///   kMatrix          9  row by row
///   kSixD            6  first column, second column (Zhou et al. 2019)
///   kExponentialMap  3  axis times angle, unwrapped along time: angles grow past pi, over any
///                       number of turns, as long as no two frames lie more than half a turn apart
///                       (MotionAug's reference compares with the raw value and repairs one frame)
///   kEuler           3  angles in `euler_order`, as math::ToEuler gives them
struct RotationCodec {
  RotationRepresentation representation = RotationRepresentation::kQuaternion;
  math::EulerOrder euler_order = math::kZYX;  ///< of kEuler only

  int width() const;
};

/// Rows are frames. Columns: the root position (3, metres) where it is included, then the joints in
/// the skeleton's order, `width()` each.
using PoseMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

PoseMatrix EncodePoses(const Clip& clip, const RotationCodec& codec,
                       bool with_root_position = true);

/// Inverse of EncodePoses. Without root positions the root stays at the origin.
/// 6D values need not be orthonormal (Gram-Schmidt); matrices and quaternions must be rotations.
/// Errors: kInvalidArgument, naming frame and joint: WRONG_SHAPE (columns), NOT_FINITE,
/// NOT_A_ROTATION, DEGENERATE_ROTATION; and those of Clip::Create.
StatusOr<Clip> DecodePoses(const PoseMatrix& poses, const RotationCodec& codec, std::string name,
                           SkeletonPtr skeleton, double frame_rate, bool with_root_position = true);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_POSE_CODEC_H_
