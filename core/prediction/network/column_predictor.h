#ifndef POISE_CORE_PREDICTION_NETWORK_COLUMN_PREDICTOR_H_
#define POISE_CORE_PREDICTION_NETWORK_COLUMN_PREDICTOR_H_

#include <memory>
#include <utility>

#include "core/base/tensor_file.h"
#include "core/prediction/network/network_weights.h"
#include "core/prediction/network/pose_columns.h"

namespace poise::prediction {

/// A network from rows of columns to rows of columns. `Family` derives from it and has
///   - Status Load(const Config&, const base::TensorFile&): all of `arguments_` but the batch;
///   - static void (*Kernel())(const Arguments&): its forward pass, for this CPU.
/// `Arguments` are (batch, past, columns) `inputs` and (batch, future, columns) `outputs`, among
/// others.
template <typename Family, typename Config, typename Arguments>
class ColumnPredictor : public NetworkPredictor {
 public:
  /// `weights`: parameters and buffers of the family's network by their names.
  /// Errors: those of TensorFile::Floats and PoseColumns::Load.
  static StatusOr<std::shared_ptr<const Family>> Create(const Config& config, NetworkBody body,
                                                        const base::TensorFile& weights) {
    POISE_ASSIGN_OR_RETURN(PoseColumns columns, PoseColumns::Load(weights, body));
    std::shared_ptr<Family> predictor(new Family(config, std::move(body), std::move(columns)));
    POISE_RETURN_IF_ERROR(predictor->Load(config, weights));
    return predictor;
  }

 protected:
  using Base = ColumnPredictor;

  ColumnPredictor(const Config& config, NetworkBody body, PoseColumns columns)
      : NetworkPredictor(std::move(body), config.past_frames, config.future_frames),
        columns_(std::move(columns)) {}

  const PoseColumns& columns() const { return columns_; }

  NetworkWeights numbers_;
  Arguments arguments_ = {};  // but for the batch

 private:
  Sizes sizes() const final {
    const size_t count = columns_.count();
    return {signature().past_frames * count, signature().max_future_frames * count};
  }
  void Encode(const motion::Clip& past, float* inputs) const final {
    columns_.Encode(past, signature().past_frames, inputs);
  }
  void Forward(int batch, const float* inputs, float* outputs) const final {
    static const auto kernel = Family::Kernel();
    Arguments arguments = arguments_;
    arguments.batch = batch;
    arguments.inputs = inputs;
    arguments.outputs = outputs;
    kernel(arguments);
  }
  void Decode(const motion::Clip& past, const float* outputs, FuturePoses& future) const final {
    columns_.Decode(past, outputs, future);
  }

  const PoseColumns columns_;
};

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_NETWORK_COLUMN_PREDICTOR_H_
