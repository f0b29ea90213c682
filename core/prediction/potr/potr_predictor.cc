#include "core/prediction/potr/potr_predictor.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/isa.h"

namespace poise::prediction {

Status PotrPredictor::Load(const PotrConfig& config, const base::TensorFile& weights) {
  arguments_.sizes = {.columns = columns().count(),
                      .past = config.past_frames,
                      .future = config.future_frames,
                      .node_width = config.node_width,
                      .joint_width = config.joint_width,
                      .width = config.width,
                      .heads = config.heads,
                      .layers = config.layers,
                      .hidden = config.hidden};
  arguments_.residual = config.residual;
  if (columns().count() % 3 != 0) {
    return base::InvalidArgument(
        "MALFORMED_CARD", "model",
        fmt::format("{} columns are no joints with three each", columns().count()));
  }
  POISE_RETURN_IF_ERROR(LoadEmbedding(weights));
  for (int i = 0; i < config.layers; ++i) {
    POISE_RETURN_IF_ERROR(LoadEncoder(weights, fmt::format("encoder{}_", i)));
    POISE_RETURN_IF_ERROR(LoadDecoder(weights, fmt::format("decoder{}_", i)));
  }
  positions_ = PotrPositions(std::max(config.past_frames, config.future_frames), config.width);
  arguments_.encoder = encoder_.data();
  arguments_.decoder = decoder_.data();
  arguments_.positions = positions_.data();
  return absl::OkStatus();
}

Status PotrPredictor::LoadEmbedding(const base::TensorFile& weights) {
  const PotrSizes& s = arguments_.sizes;
  const int nodes = s.columns / 3;
  const int inputs[] = {3, s.node_width, s.node_width, s.node_width};
  for (int i = 0; i < 4; ++i) {
    const bool last = i == 3;
    POISE_ASSIGN_OR_RETURN(arguments_.graphs[i],
                           numbers_.TakeGraph(weights, fmt::format("graph{}", i),
                                              {.nodes = nodes,
                                               .inputs = inputs[i],
                                               .outputs = last ? s.joint_width : s.node_width,
                                               .biased = false,
                                               .normed = !last}));
  }
  POISE_ASSIGN_OR_RETURN(arguments_.frame, numbers_.TakeLinear(weights, "frame", s.width,
                                                               int64_t{nodes} * s.joint_width));
  POISE_ASSIGN_OR_RETURN(arguments_.pose, numbers_.TakeLinear(weights, "pose", s.columns, s.width));
  return absl::OkStatus();
}

StatusOr<AttentionWeights> PotrPredictor::TakeAttention(const base::TensorFile& weights,
                                                        const std::string& name) {
  const int64_t width = arguments_.sizes.width;
  AttentionWeights attention;
  POISE_ASSIGN_OR_RETURN(attention.in,
                         numbers_.TakeLinear(weights, name + ".in", 3 * width, width));
  POISE_ASSIGN_OR_RETURN(attention.out, numbers_.TakeLinear(weights, name + ".out", width, width));
  return attention;
}

Status PotrPredictor::LoadEncoder(const base::TensorFile& weights, const std::string& name) {
  const int64_t width = arguments_.sizes.width, hidden = arguments_.sizes.hidden;
  PotrEncoderLayer& layer = encoder_.emplace_back();
  POISE_ASSIGN_OR_RETURN(layer.norm1, numbers_.TakeNorm(weights, name + "norm1", width));
  POISE_ASSIGN_OR_RETURN(layer.attention, TakeAttention(weights, name + "attention"));
  POISE_ASSIGN_OR_RETURN(layer.norm2, numbers_.TakeNorm(weights, name + "norm2", width));
  POISE_ASSIGN_OR_RETURN(layer.up, numbers_.TakeLinear(weights, name + "up", hidden, width));
  POISE_ASSIGN_OR_RETURN(layer.down, numbers_.TakeLinear(weights, name + "down", width, hidden));
  return absl::OkStatus();
}

Status PotrPredictor::LoadDecoder(const base::TensorFile& weights, const std::string& name) {
  const int64_t width = arguments_.sizes.width, hidden = arguments_.sizes.hidden;
  PotrDecoderLayer& layer = decoder_.emplace_back();
  POISE_ASSIGN_OR_RETURN(layer.norm1, numbers_.TakeNorm(weights, name + "norm1", width));
  POISE_ASSIGN_OR_RETURN(layer.self, TakeAttention(weights, name + "self"));
  POISE_ASSIGN_OR_RETURN(layer.norm2, numbers_.TakeNorm(weights, name + "norm2", width));
  POISE_ASSIGN_OR_RETURN(layer.cross, TakeAttention(weights, name + "cross"));
  POISE_ASSIGN_OR_RETURN(layer.norm3, numbers_.TakeNorm(weights, name + "norm3", width));
  POISE_ASSIGN_OR_RETURN(layer.up, numbers_.TakeLinear(weights, name + "up", hidden, width));
  POISE_ASSIGN_OR_RETURN(layer.down, numbers_.TakeLinear(weights, name + "down", width, hidden));
  return absl::OkStatus();
}

void (*PotrPredictor::Kernel())(const PotrArguments&) {
  return base::SelectKernel(isa_v2::PotrKernel, isa_v3::PotrKernel, isa_v4::PotrKernel);
}

}  // namespace poise::prediction
