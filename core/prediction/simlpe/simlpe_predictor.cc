#include "core/prediction/simlpe/simlpe_predictor.h"

#include <fmt/format.h>

#include <utility>

#include "core/base/isa.h"

namespace poise::prediction {

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

void (*SimlpePredictor::Kernel())(const SimlpeArguments&) {
  return base::SelectKernel(isa_v2::SimlpeKernel, isa_v3::SimlpeKernel, isa_v4::SimlpeKernel);
}

}  // namespace poise::prediction
