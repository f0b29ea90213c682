#ifndef POISE_CORE_PREDICTION_TENSORS_COLUMN_TENSORS_H_
#define POISE_CORE_PREDICTION_TENSORS_COLUMN_TENSORS_H_

#include <torch/torch.h>

#include "core/prediction/network_body.h"
#include "core/prediction/tensors/predictor_net.h"

namespace poise::prediction {

/// Which columns a network works on.
struct ColumnChoice {
  bool root = false;        ///< the root's six
  bool moving = false;      ///< of joints' columns those that count | all three of each joint
  bool normalised = false;  ///< less their mean, divided by their deviation over the training set
};

/// LibTorch's side of PoseColumns, whose buffers it holds.
/// Shapes: rows (batch, frames, columns)
class ColumnTensors : public torch::nn::Module {
 public:
  ColumnTensors(const ColumnChoice& choice, const NetworkBody& body, const EulerMeasure& measure);

  int64_t count() const { return used_.size(0); }
  /// Takes mean and deviation from windows, where columns are normalised.
  void Fit(const PoseTensors& windows, int past_frames);
  /// Rows of all frames of the windows, of which the first `past_frames` are observed.
  torch::Tensor Encode(const PoseTensors& windows, int past_frames) const;
  /// Poses of rows that follow the observed frames.
  PoseTensors Decode(const PoseTensors& windows, int past_frames, const torch::Tensor& rows) const;

 private:
  torch::Tensor All(const PoseTensors& windows, int past_frames) const;

  const bool root_, normalised_;
  const torch::Tensor joints_;  // int64
  torch::Tensor used_;          // (columns) int64, among the root's and all joints'
  torch::Tensor sense_, mean_, scale_;
};

/// A family that works on rows of columns.
class ColumnNet : public PredictorNet {
 public:
  int past_frames() const override { return past_frames_; }
  int future_frames() const override { return future_frames_; }
  void Fit(const PoseTensors& windows) override { columns_->Fit(windows, past_frames_); }
  PoseTensors Predict(const PoseTensors& windows) override;
  /// Past rows to future rows.
  virtual torch::Tensor Forward(const torch::Tensor& past) = 0;

 protected:
  ColumnNet(int past_frames, int future_frames, const ColumnChoice& choice, const NetworkBody& body,
            const EulerMeasure& measure);

  const ColumnTensors& columns() const { return *columns_; }
  /// Mean over windows and `frames` frames that were recorded of an error (batch, frames): the
  /// future's, or all frames'.
  torch::Tensor MeanRecorded(const PoseTensors& windows, const torch::Tensor& error) const;

 private:
  const int past_frames_, future_frames_;
  const std::shared_ptr<ColumnTensors> columns_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_TENSORS_COLUMN_TENSORS_H_
