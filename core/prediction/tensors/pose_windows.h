#ifndef POISE_CORE_PREDICTION_TENSORS_POSE_WINDOWS_H_
#define POISE_CORE_PREDICTION_TENSORS_POSE_WINDOWS_H_

#include <torch/torch.h>

#include <span>
#include <string_view>
#include <vector>

#include "core/base/tensor_file.h"
#include "core/motion/clip.h"

namespace poise::prediction {

/// Poses as tensors, single precision.
/// Shapes: rotations (batch, frames, joints, 4) w x y z; positions (batch, frames, 3) [m];
///         recorded (batch, frames) 1, or 0 after the end of a sequence, where its last pose is
///         repeated; undefined: all are recorded
struct PoseTensors {
  torch::Tensor rotations;
  torch::Tensor positions;
  torch::Tensor recorded = {};
};

PoseTensors ToTensors(const motion::Clip& clip);

/// Windows of one length cut out of clips, gathered into batches for training.
class PoseWindows {
 public:
  explicit PoseWindows(int window) : window_(window) {}

  /// Adds the windows that begin at `starts` of the clip. Precondition: their first frames lie
  /// inside; all clips have equally many joints.
  void Add(const motion::Clip& clip, std::span<const int> starts);

  int64_t size() const { return static_cast<int64_t>(starts_.size()); }
  PoseTensors Gather(std::span<const int64_t> windows) const;

  /// Adds all poses, one clip after the other, and where the windows begin among them:
  /// `prefix` + "rotations" (frames, joints, 4) w x y z, "positions" (frames, 3) [m], "starts"
  /// (windows). Precondition: there are windows.
  Status AppendTo(base::TensorFile& file, std::string_view prefix) const;

 private:
  void Join() const;

  int window_;
  int64_t frames_ = 0;
  std::vector<torch::Tensor> rotations_;  // a clip each: (frames, joints, 4)
  std::vector<torch::Tensor> positions_;
  std::vector<int64_t> starts_;  // among all frames
  std::vector<int64_t> ends_;    // of the clips that the windows are of, likewise
  mutable torch::Tensor all_rotations_, all_positions_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_TENSORS_POSE_WINDOWS_H_
