#ifndef POISE_CORE_MATH_ROTATION_H_
#define POISE_CORE_MATH_ROTATION_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <string>
#include <string_view>

#include "core/base/status.h"

/// Rotations and their representations. The internal one is the unit quaternion (order w x y z when
/// written as numbers); the others exist at the borders: files, networks, metrics.
/// Convention: column vectors, right-handed, active; R(a) * R(b) applies b first.
namespace poise::math {

using Vec3 = Eigen::Vector3d;
using Quat = Eigen::Quaterniond;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;

/// Order of three elementary rotations, as the product is written: kZXY means Rz * Rx * Ry.
/// Any three axes with no two neighbours equal (proper Euler orders such as zxz included).
struct EulerOrder {
  std::array<int, 3> axes;  ///< 0 = x, 1 = y, 2 = z

  friend bool operator==(const EulerOrder&, const EulerOrder&) = default;
};

inline constexpr EulerOrder kXYZ{{0, 1, 2}};
inline constexpr EulerOrder kZXY{{2, 0, 1}};
inline constexpr EulerOrder kZYX{{2, 1, 0}};

/// "ZXY" <-> order. Errors: kInvalidArgument (MALFORMED_EULER_ORDER).
StatusOr<EulerOrder> ParseEulerOrder(std::string_view text);
std::string EulerOrderName(const EulerOrder& order);

/// Angles in radians, in the order of the product: FromEuler((a, b, c), kZXY) = Rz(a) Rx(b) Ry(c).
Quat FromEuler(const Vec3& angles, const EulerOrder& order);

/// Inverse of FromEuler: the middle angle in [-pi/2, pi/2] ([0, pi] for proper Euler orders), the
/// others in (-pi, pi]. At gimbal lock the third angle is 0.
Vec3 ToEuler(const Quat& rotation, const EulerOrder& order);

/// Rotation vector (exponential map): axis times angle, any length.
Quat FromRotationVector(const Vec3& vector);
/// Length in [0, pi].
Vec3 ToRotationVector(const Quat& rotation);
/// The equivalent of `vector` (same rotation, angle + 2 pi k) that is nearest to `previous`: apply
/// along a sequence, feeding back the chosen value, for true unwrapping (MotionAug's reference
/// compares with the raw value and repairs one frame only).
Vec3 UnwrapRotationVector(const Vec3& vector, const Vec3& previous);

/// 6D representation (Zhou et al. 2019): the first two columns of the matrix, one after the other.
Vec6 ToSixD(const Quat& rotation);
/// Gram-Schmidt on two columns. Errors: kInvalidArgument (DEGENERATE_ROTATION) when they are
/// parallel, zero or not finite.
StatusOr<Quat> FromSixD(const Vec6& columns);

/// Errors: kInvalidArgument (NOT_A_ROTATION) unless orthonormal with determinant +1 to `tolerance`.
StatusOr<Quat> FromMatrix(const Mat3& matrix, double tolerance = 1e-4);

/// Smallest angle that turns a onto b, in [0, pi].
double GeodesicDistance(const Quat& a, const Quat& b);

/// The smallest rotation that turns direction `from` onto direction `to` (lengths do not matter).
/// Opposite directions turn about an arbitrary perpendicular axis; a zero vector gives identity.
Quat SwingBetween(const Vec3& from, const Vec3& to);

/// The part of `rotation` that turns about `axis` (unit): rotation = swing * twist.
Quat TwistAbout(const Quat& rotation, const Vec3& axis);

}  // namespace poise::math

#endif  // POISE_CORE_MATH_ROTATION_H_
