#include "core/prediction/simlpe/simlpe_predictor.h"

#include <fmt/format.h>

#include <utility>

#include "core/base/isa.h"

namespace poise::prediction {

SimlpePredictor::SimlpePredictor(const SimlpeConfig& config, NetworkBody body, PoseColumns columns)
    : ColumnPredictor(std::move(body), config.past_frames, config.future_frames,
                      std::move(columns)) {}

StatusOr<std::shared_ptr<const SimlpePredictor>> SimlpePredictor::Create(
    const SimlpeConfig& config, NetworkBody body, const base::TensorFile& weights) {
  POISE_ASSIGN_OR_RETURN(PoseColumns columns, PoseColumns::Load(weights, body));
  std::shared_ptr<SimlpePredictor> predictor(
      new SimlpePredictor(config, std::move(body), std::move(columns)));
  POISE_RETURN_IF_ERROR(predictor->Load(config, weights));
  return predictor;
}

Status SimlpePredictor::Load(const SimlpeConfig& config, const base::TensorFile& weights) {
  SimlpeArguments& a = arguments_;
  a.columns = columns().count();
  a.past = config.past_frames;
  a.future = config.future_frames;
  a.blocks = config.blocks;
  POISE_ASSIGN_OR_RETURN(a.dct, numbers_.Take(weights, "dct", {a.past, a.past}));
  POISE_ASSIGN_OR_RETURN(a.in, numbers_.TakeLinear(weights, "in", a.columns, a.columns));
  POISE_ASSIGN_OR_RETURN(a.out, numbers_.TakeLinear(weights, "out", a.columns, a.columns));
  for (int i = 0; i < config.blocks; ++i) {
    SimlpeBlock& block = layers_.emplace_back();
    POISE_ASSIGN_OR_RETURN(
        block.along_time,
        numbers_.TakeLinear(weights, fmt::format("block{}_time", i), a.past, a.past));
    POISE_ASSIGN_OR_RETURN(block.norm,
                           numbers_.TakeNorm(weights, fmt::format("block{}_norm", i), a.columns));
  }
  a.layers = layers_.data();
  return absl::OkStatus();
}

void SimlpePredictor::Forward(int batch, const float* inputs, float* outputs) const {
  static const auto kernel =
      base::SelectKernel(isa_v2::SimlpeKernel, isa_v3::SimlpeKernel, isa_v4::SimlpeKernel);
  SimlpeArguments arguments = arguments_;
  arguments.batch = batch;
  arguments.inputs = inputs;
  arguments.outputs = outputs;
  kernel(arguments);
}

}  // namespace poise::prediction
