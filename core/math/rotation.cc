#include "core/math/rotation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

namespace poise::math {
namespace {

constexpr double kPi = std::numbers::pi;
// Below this sine (or cosine) of the middle angle the outer two axes coincide to rounding.
constexpr double kGimbalLock = 1e-9;

// +1 when (a, b, c) is an even permutation of the axes, -1 when odd.
double Parity(int a, int b) { return (b - a + 3) % 3 == 1 ? 1.0 : -1.0; }

}  // namespace

StatusOr<EulerOrder> ParseEulerOrder(std::string_view text) {
  EulerOrder order{};
  bool valid = text.size() == 3;
  for (size_t i = 0; valid && i < 3; ++i) {
    const int axis = std::toupper(static_cast<unsigned char>(text[i])) - 'X';
    valid = axis >= 0 && axis <= 2 && (i == 0 || axis != order.axes[i - 1]);
    order.axes[i] = axis;
  }
  if (!valid) {
    return base::InvalidArgument("MALFORMED_EULER_ORDER", "",
                                 fmt::format("'{}' is no Euler order like ZXY", text));
  }
  return order;
}

std::string EulerOrderName(const EulerOrder& order) {
  std::string name;
  for (const int axis : order.axes) name += static_cast<char>('X' + axis);
  return name;
}

Quat FromEuler(const Vec3& angles, const EulerOrder& order) {
  Quat rotation = Quat::Identity();
  for (int i = 0; i < 3; ++i) {
    Quat elementary(std::cos(angles[i] / 2), 0, 0, 0);
    elementary.vec()[order.axes[i]] = std::sin(angles[i] / 2);
    rotation = rotation * elementary;
  }
  return rotation;
}

Vec3 ToEuler(const Quat& rotation, const EulerOrder& order) {
  const Mat3 m = rotation.normalized().toRotationMatrix();
  const auto [i, j, k] = order.axes;
  Vec3 angles;
  if (i != k) {
    // Tait-Bryan: R = Ri(a) Rj(b) Rk(c), R(i,k) = s sin b with s the parity of (i, j, k).
    const double s = Parity(i, j);
    const double sin_b = std::clamp(s * m(i, k), -1.0, 1.0);
    const double cos_b = std::hypot(m(i, i), m(i, j));
    angles[1] = std::atan2(sin_b, cos_b);
    if (cos_b > kGimbalLock) {
      angles[0] = std::atan2(-s * m(j, k), m(k, k));
      angles[2] = std::atan2(-s * m(i, j), m(i, i));
    } else {
      angles[0] = std::atan2(s * m(k, j), m(j, j));
      angles[2] = 0;
    }
  } else {
    // Proper Euler: R = Ri(a) Rj(b) Ri(c), l the remaining axis, R(i,i) = cos b.
    const int l = 3 - i - j;
    const double s = Parity(i, j);
    const double sin_b = std::hypot(m(i, j), m(i, l));
    angles[1] = std::atan2(sin_b, m(i, i));
    if (sin_b > kGimbalLock) {
      angles[0] = std::atan2(m(j, i), -s * m(l, i));
      angles[2] = std::atan2(m(i, j), s * m(i, l));
    } else {
      angles[0] = std::atan2(s * m(l, j), m(j, j));
      angles[2] = 0;
    }
  }
  return angles;
}

Quat FromRotationVector(const Vec3& vector) {
  const double half = vector.norm() / 2;
  // sin(x)/x by its series where the quotient would lose digits.
  const double scale = half < 1e-4 ? 0.5 * (1 - half * half / 6) : 0.5 * std::sin(half) / half;
  Quat rotation;
  rotation.w() = std::cos(half);
  rotation.vec() = scale * vector;
  return rotation;
}

Vec3 ToRotationVector(const Quat& rotation) {
  const Quat q = rotation.normalized();
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const double sine = q.vec().norm();
  if (sine < 1e-8) return 2.0 * sign * q.vec();
  return sign * 2.0 * std::atan2(sine, sign * q.w()) / sine * q.vec();
}

Vec3 UnwrapRotationVector(const Vec3& vector, const Vec3& previous) {
  const double angle = vector.norm();
  // At identity every axis will do: keep the previous one.
  const Vec3 axis = angle > 1e-12         ? Vec3(vector / angle)
                    : previous.norm() > 1 ? previous.normalized()
                                          : Vec3::Zero();
  const double turns = std::round((previous.dot(axis) - angle) / (2 * kPi));
  return (angle + 2 * kPi * turns) * axis;
}

Vec6 ToSixD(const Quat& rotation) {
  const Mat3 m = rotation.toRotationMatrix();
  Vec6 columns;
  columns << m.col(0), m.col(1);
  return columns;
}

StatusOr<Quat> FromSixD(const Vec6& columns) {
  const Vec3 a = columns.head<3>(), b = columns.tail<3>();
  const Vec3 normal = a.cross(b);
  if (!columns.allFinite() || a.norm() < 1e-8 || normal.norm() < 1e-8 * a.norm()) {
    return base::InvalidArgument(
        "DEGENERATE_ROTATION", "",
        "the two columns of a 6D rotation are parallel, zero or not finite");
  }
  Mat3 m;
  m.col(0) = a.normalized();
  m.col(2) = normal.normalized();
  m.col(1) = m.col(2).cross(m.col(0));
  return Quat(m);
}

StatusOr<Quat> FromMatrix(const Mat3& matrix, double tolerance) {
  const double error = (matrix * matrix.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff();
  if (!(error <= tolerance) || matrix.determinant() < 0) {
    return base::InvalidArgument(
        "NOT_A_ROTATION", "",
        fmt::format("matrix is no rotation: R R^T differs from identity by {}, determinant {}",
                    error, matrix.determinant()));
  }
  return Quat(matrix).normalized();
}

double GeodesicDistance(const Quat& a, const Quat& b) {
  const Quat difference = a.conjugate() * b;
  return 2.0 * std::atan2(difference.vec().norm(), std::abs(difference.w()));
}

Quat SwingBetween(const Vec3& from, const Vec3& to) {
  if (from.squaredNorm() < 1e-24 || to.squaredNorm() < 1e-24) return Quat::Identity();
  return Quat::FromTwoVectors(from, to);
}

Quat TwistAbout(const Quat& rotation, const Vec3& axis) {
  const double along = rotation.vec().dot(axis);
  const double norm = std::hypot(rotation.w(), along);
  if (norm < 1e-12) return Quat::Identity();
  Quat twist;
  twist.w() = rotation.w() / norm;
  twist.vec() = along / norm * axis;
  return twist;
}

}  // namespace poise::math
