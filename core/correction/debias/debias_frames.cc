#include "core/correction/debias/debias_frames.h"

#include <algorithm>
#include <cmath>

#include "core/math/rotation.h"

namespace poise::correction {
namespace {

using math::Quat;
using math::Vec3;

constexpr int kJoints = 16;
constexpr int kSixD = 6;
constexpr int kPoseWidth = 1 + kSixD * kJoints;  // height, tilt, joints
constexpr int kWayWidth = 3 + 3 * kJoints;       // root, rotation vectors

// The turn about the vertical: what is left of the root's rotation is its tilt.
Quat Heading(const motion::Clip& clip, int frame) {
  return math::TwistAbout(clip.rotation(frame, 0), Vec3::UnitY());
}

// Puts numbers one behind the other into a row.
class RowWriter {
 public:
  RowWriter(FrameRows& rows, int row) : rows_(rows), row_(row) {}
  template <typename Vector>
  void Put(const Vector& values) {
    for (const double value : values) rows_(row_, column_++) = static_cast<float>(value);
  }

 private:
  FrameRows& rows_;
  const int row_;
  int column_ = 0;
};

}  // namespace

int InputWidth(const DebiasInput& input) { return kPoseWidth + 2 * input.moments * kWayWidth; }

FrameRows MakeFrameRows(const motion::Clip& clip, const DebiasInput& input) {
  const int frames = clip.num_frames();
  const double step = std::max(1.0, std::round(input.spacing_s * clip.frame_rate()));
  FrameRows rows(frames, InputWidth(input));
  for (int f = 0; f < frames; ++f) {
    RowWriter row(rows, f);
    const Quat heading = Heading(clip, f);
    row.Put(Eigen::Matrix<double, 1, 1>(clip.root_position(f).y()));
    row.Put(math::ToSixD(heading.conjugate() * clip.rotation(f, 0)));
    for (int j = 1; j < kJoints; ++j) row.Put(math::ToSixD(clip.rotation(f, j)));
    for (int moment = -input.moments; moment <= input.moments; ++moment) {
      if (moment == 0) continue;
      const int there = std::clamp(f + moment * static_cast<int>(step), 0, frames - 1);
      row.Put(Vec3(heading.conjugate() * (clip.root_position(there) - clip.root_position(f))));
      for (int j = 0; j < kJoints; ++j) {
        row.Put(math::ToRotationVector(clip.rotation(f, j).conjugate() * clip.rotation(there, j)));
      }
    }
  }
  return rows;
}

FrameRows CorrectionBetween(const motion::Clip& imitated, const motion::Clip& original) {
  FrameRows rows(imitated.num_frames(), kCorrectionWidth);
  for (int f = 0; f < imitated.num_frames(); ++f) {
    RowWriter row(rows, f);
    const Quat to_heading = Heading(imitated, f).conjugate();
    row.Put(Vec3(to_heading * (original.root_position(f) - imitated.root_position(f))));
    row.Put(math::Vec6(math::ToSixD(to_heading * original.rotation(f, 0)) -
                       math::ToSixD(to_heading * imitated.rotation(f, 0))));
    for (int j = 1; j < kJoints; ++j) {
      row.Put(math::Vec6(math::ToSixD(original.rotation(f, j)) -
                         math::ToSixD(imitated.rotation(f, j))));
    }
  }
  return rows;
}

motion::Clip ApplyCorrection(motion::Clip imitated, const FrameRows& correction) {
  for (int f = 0; f < imitated.num_frames(); ++f) {
    const Quat heading = Heading(imitated, f);
    const Vec3 way = correction.row(f).head<3>().cast<double>();
    // Additions and products by what is no change would still round.
    if (!way.isZero(0)) imitated.root_position(f) += heading * way;
    for (int j = 0; j < kJoints; ++j) {
      const math::Vec6 change = correction.row(f).segment<kSixD>(3 + kSixD * j).cast<double>();
      if (change.isZero(0)) continue;
      const Quat base = j == 0 ? heading : Quat::Identity();
      Quat& rotation = imitated.rotation(f, j);
      const StatusOr<Quat> corrected =
          math::FromSixD(math::ToSixD(base.conjugate() * rotation) + change);
      if (corrected.ok()) rotation = (base * *corrected).normalized();
    }
  }
  return imitated;
}

}  // namespace poise::correction
