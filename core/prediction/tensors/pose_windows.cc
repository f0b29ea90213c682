#include "core/prediction/tensors/pose_windows.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/learning/nn/module_state.h"

namespace poise::prediction {

PoseTensors ToTensors(const motion::Clip& clip) {
  const int64_t frames = clip.num_frames(), joints = clip.num_joints();
  PoseTensors poses{torch::empty({1, frames, joints, 4}), torch::empty({1, frames, 3})};
  float* rotation = poses.rotations.data_ptr<float>();
  for (const motion::Quat& q : clip.rotations()) {
    for (const double value : {q.w(), q.x(), q.y(), q.z()}) *rotation++ = static_cast<float>(value);
  }
  float* position = poses.positions.data_ptr<float>();
  for (const motion::Vec3& p : clip.root_positions()) {
    for (const double value : p) *position++ = static_cast<float>(value);
  }
  return poses;
}

void PoseWindows::Add(const motion::Clip& clip, std::span<const int> starts) {
  const PoseTensors poses = ToTensors(clip);
  rotations_.push_back(poses.rotations[0]);
  positions_.push_back(poses.positions[0]);
  const int64_t end = frames_ + clip.num_frames();
  for (const int start : starts) {
    starts_.push_back(frames_ + start);
    ends_.push_back(end);
  }
  frames_ = end;
  all_rotations_ = torch::Tensor();
}

void PoseWindows::Join() const {
  if (all_rotations_.defined()) return;
  all_rotations_ = torch::cat(rotations_);
  all_positions_ = torch::cat(positions_);
}

Status PoseWindows::AppendTo(base::TensorFile& file, std::string_view prefix) const {
  Join();
  const auto append = [&](const char* name, const torch::Tensor& tensor) -> Status {
    POISE_ASSIGN_OR_RETURN(file.tensors[fmt::format("{}{}", prefix, name)],
                           learning::ToRecord(tensor));
    return absl::OkStatus();
  };
  POISE_RETURN_IF_ERROR(append("rotations", all_rotations_));
  POISE_RETURN_IF_ERROR(append("positions", all_positions_));
  return append("starts", torch::tensor(starts_));
}

PoseTensors PoseWindows::Gather(std::span<const int64_t> windows) const {
  Join();
  const auto count = static_cast<int64_t>(windows.size());
  torch::Tensor frames = torch::empty({count, window_}, torch::kInt64);
  torch::Tensor recorded = torch::ones({count, window_});
  auto frame = frames.accessor<int64_t, 2>();
  auto is_recorded = recorded.accessor<float, 2>();
  for (int64_t i = 0; i < count; ++i) {
    for (int64_t t = 0; t < window_; ++t) {
      const int64_t wanted = starts_[windows[i]] + t, last = ends_[windows[i]] - 1;
      frame[i][t] = std::min(wanted, last);
      if (wanted > last) is_recorded[i][t] = 0;
    }
  }
  const torch::Tensor flat = frames.flatten();
  return {all_rotations_.index_select(0, flat).view({count, window_, -1, 4}),
          all_positions_.index_select(0, flat).view({count, window_, 3}), recorded};
}

}  // namespace poise::prediction
