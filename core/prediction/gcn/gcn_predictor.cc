#include "core/prediction/gcn/gcn_predictor.h"

#include <fmt/format.h>

#include <utility>

#include "core/base/isa.h"

namespace poise::prediction {

Status GcnPredictor::Load(const GcnConfig& config, const base::TensorFile& weights) {
  const int nodes = columns().count(), kept = config.kept_coefficients();
  for (int i = 0; i < config.layers(); ++i) {
    const bool last = i == config.layers() - 1;
    POISE_ASSIGN_OR_RETURN(layers_.emplace_back(),
                           numbers_.TakeGraph(weights, fmt::format("layer{}", i),
                                              {.nodes = nodes,
                                               .inputs = i == 0 ? kept : config.width,
                                               .outputs = last ? kept : config.width,
                                               .biased = true,
                                               .normed = !last}));
  }
  arguments_ = {.nodes = nodes,
                .past = config.past_frames,
                .future = config.future_frames,
                .coefficients = kept,
                .width = config.width,
                .blocks = config.blocks,
                .dct = nullptr,
                .layers = layers_.data(),
                .batch = 0,
                .inputs = nullptr,
                .outputs = nullptr};
  POISE_ASSIGN_OR_RETURN(arguments_.dct, numbers_.Take(weights, "dct", {kept, config.frames()}));
  return absl::OkStatus();
}

void (*GcnPredictor::Kernel())(const GcnArguments&) {
  return base::SelectKernel(isa_v2::GcnKernel, isa_v3::GcnKernel, isa_v4::GcnKernel);
}

}  // namespace poise::prediction
