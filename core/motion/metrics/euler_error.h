#ifndef POISE_CORE_MOTION_METRICS_EULER_ERROR_H_
#define POISE_CORE_MOTION_METRICS_EULER_ERROR_H_

#include <vector>

#include "core/motion/pose_codec.h"

namespace poise::motion {

/// Whose rotation vectors a table holds.
enum class RotationSense {
  kColumnVectors,  ///< as Poise's rotations
  kRowVectors,     ///< of the transposed matrices, as the CMU text files have them
};

/// The rotation vectors of a clip's joints, each of length [0, pi], neither unwrapped nor scaled:
/// the columns on which the published error is defined.
/// Shapes: (frames, joints * 3)
PoseMatrix RotationVectors(const Clip& clip, RotationSense sense);

/// Euler angles of one rotation vector as prediction papers measure them: R = Rx(-a) Ry(-b) Rz(-c)
/// for the result (a, b, c), with the axis divided by angle + 1.19e-7.
/// Source: reference sec. 1.8, steps 2 and 3.
Vec3 EulerOfRotationVector(const Vec3& rotation_vector);

/// Which columns of a table count in the error. Shape: (joints * 3); the root's three never count.
using ColumnMask = std::vector<bool>;

enum class EulerErrorVariant {
  kMovingColumns,  ///< of the counting columns those that move in the target by more than 1e-4
                   ///< (population deviation over its frames): DMGNN, V-DMGNN-GAN
  kAllColumns,     ///< all that count: LTD, MotionAug
};

/// The published error: per frame the Euclidean norm of the difference in Euler angles [rad], which
/// is not wrapped: a pose that differs by 2 pi in one angle is far away.
/// Shapes: target, prediction (frames, joints * 3) rotation vectors; counts (joints * 3);
///         result (frames)
/// Source: reference sec. 1.8, steps 4 to 6.
/// Errors: kInvalidArgument WRONG_SHAPE.
StatusOr<std::vector<double>> EulerErrors(const PoseMatrix& target, const PoseMatrix& prediction,
                                          const ColumnMask& counts, EulerErrorVariant variant);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_METRICS_EULER_ERROR_H_
