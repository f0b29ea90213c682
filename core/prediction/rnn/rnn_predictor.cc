#include "core/prediction/rnn/rnn_predictor.h"

#include <utility>
#include <vector>

#include "core/base/isa.h"

namespace poise::prediction {

RnnPredictor::RnnPredictor(const RnnConfig& config, NetworkBody body, PoseColumns columns)
    : ColumnPredictor(std::move(body), config.past_frames, config.future_frames,
                      std::move(columns)) {}

StatusOr<std::shared_ptr<const RnnPredictor>> RnnPredictor::Create(
    const RnnConfig& config, NetworkBody body, const base::TensorFile& weights) {
  POISE_ASSIGN_OR_RETURN(PoseColumns columns, PoseColumns::Load(weights, body));
  std::shared_ptr<RnnPredictor> predictor(
      new RnnPredictor(config, std::move(body), std::move(columns)));
  POISE_RETURN_IF_ERROR(predictor->Load(config, weights));
  return predictor;
}

Status RnnPredictor::Load(const RnnConfig& config, const base::TensorFile& weights) {
  RnnArguments& a = arguments_;
  a.columns = columns().count();
  a.past = config.past_frames;
  a.future = config.future_frames;
  a.hidden = config.hidden;
  const int64_t gates = int64_t{3} * config.hidden;
  const auto take = [&](const char* name, std::vector<int64_t> shape) {
    return numbers_.Take(weights, name, std::move(shape));
  };
  POISE_ASSIGN_OR_RETURN(a.input.weight, take("cell.weight_ih", {gates, a.columns}));
  POISE_ASSIGN_OR_RETURN(a.input.bias, take("cell.bias_ih", {gates}));
  POISE_ASSIGN_OR_RETURN(a.state.weight, take("cell.weight_hh", {gates, a.hidden}));
  POISE_ASSIGN_OR_RETURN(a.state.bias, take("cell.bias_hh", {gates}));
  POISE_ASSIGN_OR_RETURN(a.change, numbers_.TakeLinear(weights, "change", a.columns, a.hidden));
  return absl::OkStatus();
}

void RnnPredictor::Forward(int batch, const float* inputs, float* outputs) const {
  static const auto kernel =
      base::SelectKernel(isa_v2::RnnKernel, isa_v3::RnnKernel, isa_v4::RnnKernel);
  RnnArguments arguments = arguments_;
  arguments.batch = batch;
  arguments.inputs = inputs;
  arguments.outputs = outputs;
  kernel(arguments);
}

}  // namespace poise::prediction
