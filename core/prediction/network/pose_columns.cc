#include "core/prediction/network/pose_columns.h"

namespace poise::prediction {
namespace {

using motion::Clip;
using motion::Quat;
using motion::Vec3;

Vec3 VectorAt(const double* numbers) { return Vec3(numbers[0], numbers[1], numbers[2]); }

void Write(const Vec3& vector, double*& out) {
  for (const double value : vector) *out++ = value;
}

// Columns of one frame, in use or not: the root's, then the joints'.
void WriteFrame(const Clip& clip, int frame, const std::vector<int>& joints, double sense,
                double* out) {
  const int last = clip.num_frames() - 1;
  const Quat root_from_world = clip.rotation(last, 0).conjugate();
  Write(root_from_world * Vec3(clip.root_position(frame) - clip.root_position(last)), out);
  Write(math::ToRotationVector(root_from_world * clip.rotation(frame, 0)), out);
  for (const int joint : joints) {
    Write(sense * math::ToRotationVector(clip.rotation(frame, joint)), out);
  }
}

}  // namespace

StatusOr<PoseColumns> PoseColumns::Load(const base::TensorFile& weights, const NetworkBody& body) {
  PoseColumns columns;
  columns.joints_ = body.joints;
  POISE_ASSIGN_OR_RETURN(const std::vector<float> sense,
                         weights.Floats("columns.sense", std::vector<int64_t>{1}));
  columns.sense_ = sense[0];
  const auto all = static_cast<int64_t>(kRootColumns + 3 * body.joints.size());
  POISE_ASSIGN_OR_RETURN(const std::vector<float> used,
                         weights.Floats("columns.used", std::vector<int64_t>{all}));
  for (int column = 0; column < all; ++column) {
    if (used[column] > 0) columns.used_.push_back(column);
  }
  if (columns.used_.empty()) {
    return base::InvalidArgument("MALFORMED_CARD", "model", "the network predicts no column");
  }
  columns.root_ = columns.used_.front() < kRootColumns;
  const std::vector<int64_t> shape = {columns.count()};
  POISE_ASSIGN_OR_RETURN(columns.mean_, weights.Floats("columns.mean", shape));
  POISE_ASSIGN_OR_RETURN(columns.scale_, weights.Floats("columns.scale", shape));
  return columns;
}

void PoseColumns::Encode(const Clip& past, int frames, float* rows) const {
  std::vector<double> all(kRootColumns + 3 * joints_.size());
  for (int frame = past.num_frames() - frames; frame < past.num_frames(); ++frame) {
    WriteFrame(past, frame, joints_, sense_, all.data());
    for (size_t i = 0; i < used_.size(); ++i) {
      *rows++ = (static_cast<float>(all[used_[i]]) - mean_[i]) / scale_[i];
    }
  }
}

void PoseColumns::Decode(const Clip& past, const float* rows, FuturePoses& future) const {
  const int last = past.num_frames() - 1;
  std::vector<double> all(kRootColumns + 3 * joints_.size());
  WriteFrame(past, last, joints_, sense_, all.data());
  for (int frame = 0; frame < future.num_frames(); ++frame) {
    for (size_t i = 0; i < used_.size(); ++i) all[used_[i]] = *rows++ * scale_[i] + mean_[i];
    for (size_t j = 0; j < joints_.size(); ++j) {
      future.rotation(frame, joints_[j]) =
          math::FromRotationVector(sense_ * VectorAt(all.data() + kRootColumns + 3 * j));
    }
    if (!root_) continue;
    future.root_positions[frame] += past.rotation(last, 0) * VectorAt(all.data());
    future.rotation(frame, 0) =
        past.rotation(last, 0) * math::FromRotationVector(VectorAt(all.data() + 3));
  }
}

}  // namespace poise::prediction
