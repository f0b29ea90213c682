#include "core/prediction/tensors/column_tensors.h"

#include "core/prediction/network/pose_columns.h"
#include "core/prediction/tensors/rotation_tensors.h"

namespace poise::prediction {
namespace {

using torch::Tensor;

constexpr int kRoot = PoseColumns::kRootColumns;
constexpr double kStill = 1e-4;  // deviation of a column that does not move

}  // namespace

ColumnTensors::ColumnTensors(const ColumnChoice& choice, const NetworkBody& body,
                             const EulerMeasure& measure)
    : root_(choice.root),
      normalised_(choice.normalised),
      joints_(torch::tensor(std::vector<int64_t>(body.joints.begin(), body.joints.end()))) {
  const Tensor joints = choice.moving ? measure.counts : torch::ones_like(measure.counts);
  const Tensor used = torch::cat({torch::full({kRoot}, root_ ? 1.0F : 0.0F), joints});
  used_ = used.nonzero().flatten();
  register_buffer("used", used);
  sense_ = register_buffer("sense", torch::full({1}, measure.row_vectors ? -1.0F : 1.0F));
  mean_ = register_buffer("mean", torch::zeros({count()}));
  scale_ = register_buffer("scale", torch::ones({count()}));
}

Tensor ColumnTensors::All(const PoseTensors& windows, int past_frames) const {
  const Tensor joints = (sense_ * LogMap(windows.rotations.index_select(2, joints_))).flatten(2);
  const int64_t batch = joints.size(0), frames = joints.size(1), last = past_frames - 1;
  if (!root_) return torch::cat({torch::zeros({batch, frames, kRoot}), joints}, 2);
  const Tensor root = windows.rotations.select(2, 0);
  const Tensor root_from_world = Conjugate(root.slice(1, last, last + 1));
  const Tensor path = windows.positions - windows.positions.slice(1, last, last + 1);
  return torch::cat(
      {Rotate(root_from_world, path), LogMap(Multiply(root_from_world, root)), joints}, 2);
}

void ColumnTensors::Fit(const PoseTensors& windows, int past_frames) {
  if (!normalised_) return;
  const torch::NoGradGuard no_gradient;
  const Tensor rows = All(windows, past_frames).index_select(2, used_).flatten(0, 1);
  const Tensor deviation = rows.std(0, false);
  mean_.copy_(rows.mean(0));
  scale_.copy_(torch::where(deviation < kStill, torch::ones_like(deviation), deviation));
}

Tensor ColumnTensors::Encode(const PoseTensors& windows, int past_frames) const {
  return (All(windows, past_frames).index_select(2, used_) - mean_) / scale_;
}

PoseTensors ColumnTensors::Decode(const PoseTensors& windows, int past_frames,
                                  const Tensor& rows) const {
  const int64_t last = past_frames - 1, future = rows.size(1), joints = joints_.size(0);
  const PoseTensors pose{windows.rotations.slice(1, last, last + 1),
                         windows.positions.slice(1, last, last + 1)};
  Tensor all = All(pose, 1).expand({-1, future, -1}).clone();
  all.index_copy_(2, used_, rows * scale_ + mean_);
  Tensor rotations = pose.rotations.expand({-1, future, -1, -1}).clone();
  rotations.index_copy_(2, joints_,
                        ExpMap((sense_ * all.slice(2, kRoot)).unflatten(2, {joints, 3})));
  if (!root_) return {rotations, pose.positions.expand({-1, future, -1})};
  const Tensor root = pose.rotations.select(2, 0);
  rotations.select(2, 0).copy_(Multiply(root, ExpMap(all.slice(2, 3, kRoot))));
  return {rotations, pose.positions + Rotate(root, all.slice(2, 0, 3))};
}

ColumnNet::ColumnNet(int past_frames, int future_frames, const ColumnChoice& choice,
                     const NetworkBody& body, const EulerMeasure& measure)
    : past_frames_(past_frames),
      future_frames_(future_frames),
      columns_(register_module("columns", std::make_shared<ColumnTensors>(choice, body, measure))) {
}

PoseTensors ColumnNet::Predict(const PoseTensors& windows) {
  const PoseTensors past{windows.rotations.slice(1, 0, past_frames_),
                         windows.positions.slice(1, 0, past_frames_)};
  return columns_->Decode(past, past_frames_, Forward(columns_->Encode(past, past_frames_)));
}

Tensor ColumnNet::MeanRecorded(const PoseTensors& windows, const Tensor& error) const {
  if (!windows.recorded.defined()) return error.mean();
  return (error * windows.recorded.slice(1, windows.recorded.size(1) - error.size(1))).mean();
}

}  // namespace poise::prediction
