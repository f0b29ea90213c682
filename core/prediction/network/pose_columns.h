#ifndef POISE_CORE_PREDICTION_NETWORK_POSE_COLUMNS_H_
#define POISE_CORE_PREDICTION_NETWORK_POSE_COLUMNS_H_

#include <vector>

#include "core/base/tensor_file.h"
#include "core/prediction/network/network_predictor.h"

namespace poise::prediction {

/// Poses as the published networks take them: a row per frame, of which the columns are
///   - six of the root, where it is predicted: its path [m], then its rotation vector, both from
///     the last observed frame, in the root's frame there (MotionAug has absolute ones, which wrap
///     and make a difference of where a body stands);
///   - the rotation vectors of the body's joints, in their order and in the sense of the benchmark
///     that the network learned from;
/// as far as they are in use; less a mean, divided by a scale. Columns not in use are held.
/// LibTorch's side is ColumnTensors, which saves what this reads.
class PoseColumns {
 public:
  static constexpr int kRootColumns = 6;

  /// Reads "columns.sense" (1), "columns.used" (6 + 3 joints), "columns.mean" and "columns.scale"
  /// (columns in use).
  /// Errors: those of TensorFile::Floats; kInvalidArgument MALFORMED_CARD without any column.
  static StatusOr<PoseColumns> Load(const base::TensorFile& weights, const NetworkBody& body);

  int count() const { return static_cast<int>(used_.size()); }
  /// The last `frames` of `past`: (frames, count).
  void Encode(const motion::Clip& past, int frames, float* rows) const;
  /// Rows (future frames, count) after the end of `past`.
  void Decode(const motion::Clip& past, const float* rows, FuturePoses& future) const;

 private:
  PoseColumns() = default;
  std::vector<int> joints_;
  double sense_ = 1;       // of the learned vectors: -1 for transposed matrices
  std::vector<int> used_;  // (count) index among the root's and all joints' columns
  std::vector<float> mean_, scale_;
  bool root_ = false;  // of which some are in use
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_NETWORK_POSE_COLUMNS_H_
