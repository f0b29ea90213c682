#include "core/prediction/potr/potr_net.h"

#include <fmt/format.h>

#include <cmath>

#include "core/prediction/tensors/dropout.h"

namespace poise::prediction {
namespace {

using torch::Tensor;
using torch::nn::LayerNorm;
using torch::nn::LayerNormOptions;
using torch::nn::Linear;

void Spread(Linear& linear) {
  torch::nn::init::xavier_uniform_(linear->weight);
  torch::nn::init::zeros_(linear->bias);
}

}  // namespace

Attention::Attention(int64_t width, int64_t heads, double dropout)
    : heads_(heads), dropout_(dropout) {
  in_ = register_module("in", Linear(width, 3 * width));
  out_ = register_module("out", Linear(width, width));
  Spread(in_);
  torch::nn::init::zeros_(out_->bias);
}

Tensor Attention::forward(const Tensor& query, const Tensor& key, const Tensor& value) {
  const std::vector<Tensor> weight = in_->weight.chunk(3), bias = in_->bias.chunk(3);
  const auto head = [&](const Tensor& x, int part) {  // (batch, heads, frames, width / heads)
    return torch::linear(x, weight[part], bias[part]).unflatten(2, {heads_, -1}).transpose(1, 2);
  };
  const Tensor q = head(query, 0), k = head(key, 1), v = head(value, 2);
  const double scale = 1 / std::sqrt(static_cast<double>(q.size(3)));
  const Tensor weights = torch::softmax(torch::matmul(q, k.transpose(2, 3)) * scale, -1);
  return out_(
      torch::matmul(Dropout(weights, dropout_, is_training()), v).transpose(1, 2).flatten(2));
}

PotrNet::PotrNet(const PotrConfig& config, const NetworkBody& body, const EulerMeasure& measure)
    : ColumnNet(config.past_frames, config.future_frames,
                {.root = config.root, .moving = false, .normalised = true}, body, measure),
      config_(config) {
  BuildEmbedding();
  BuildLayers();
}

void PotrNet::BuildEmbedding() {
  const int64_t nodes = columns().count() / 3, wide = config_.node_width;
  const auto add = [&](int64_t inputs, int64_t outputs, bool bent) {
    graphs_.push_back(register_module(
        fmt::format("graph{}", graphs_.size()),
        std::make_shared<GraphConvolution>(GraphConvolutionOptions{.nodes = nodes,
                                                                   .inputs = inputs,
                                                                   .outputs = outputs,
                                                                   .biased = false,
                                                                   .bent = bent,
                                                                   .dropout = config_.dropout})));
  };
  add(3, wide, true);
  add(wide, wide, true);
  add(wide, wide, true);
  add(wide, config_.joint_width, false);
  frame_ = register_module("frame", Linear(nodes * config_.joint_width, config_.width));
  Spread(frame_);
}

void PotrNet::BuildLayers() {
  const LayerNormOptions norm(std::vector<int64_t>{config_.width});
  const auto attention = [&](const std::string& name) {
    return register_module(
        name, std::make_shared<Attention>(config_.width, config_.heads, config_.dropout));
  };
  const auto linear = [&](const std::string& name, int64_t inputs, int64_t outputs) {
    Linear made = register_module(name, Linear(inputs, outputs));
    Spread(made);
    return made;
  };
  for (int i = 0; i < config_.layers; ++i) {
    const std::string name = fmt::format("encoder{}_", i);
    EncoderLayer& layer = encoder_.emplace_back();
    layer.norm1 = register_module(name + "norm1", LayerNorm(norm));
    layer.attention = attention(name + "attention");
    layer.norm2 = register_module(name + "norm2", LayerNorm(norm));
    layer.up = linear(name + "up", config_.width, config_.hidden);
    layer.down = linear(name + "down", config_.hidden, config_.width);
  }
  for (int i = 0; i < config_.layers; ++i) {
    const std::string name = fmt::format("decoder{}_", i);
    DecoderLayer& layer = decoder_.emplace_back();
    layer.norm1 = register_module(name + "norm1", LayerNorm(norm));
    layer.self = attention(name + "self");
    layer.norm2 = register_module(name + "norm2", LayerNorm(norm));
    layer.cross = attention(name + "cross");
    layer.norm3 = register_module(name + "norm3", LayerNorm(norm));
    layer.up = linear(name + "up", config_.width, config_.hidden);
    layer.down = linear(name + "down", config_.hidden, config_.width);
  }
  pose_ = linear("pose", config_.width, columns().count());
}

Tensor PotrNet::Drop(const Tensor& x) const { return Dropout(x, config_.dropout, is_training()); }

Tensor PotrNet::Positions(int frames) const {
  return torch::tensor(PotrPositions(frames, config_.width)).view({frames, config_.width});
}

Tensor PotrNet::Embed(const Tensor& rows) {
  const int64_t batch = rows.size(0), frames = rows.size(1);
  Tensor h = graphs_[0]->forward(rows.reshape({batch * frames, -1, 3}));
  h = h + graphs_[2]->forward(graphs_[1]->forward(h));
  return Drop(frame_(graphs_[3]->forward(h).flatten(1))).view({batch, frames, -1});
}

Tensor PotrNet::Encode(Tensor x) {
  const Tensor positions = Positions(static_cast<int>(x.size(1)));
  for (EncoderLayer& layer : encoder_) {
    const Tensor n = layer.norm1(x), placed = n + positions;
    x = x + Drop(layer.attention->forward(placed, placed, n));
    x = x + Drop(layer.down(Drop(torch::relu(layer.up(layer.norm2(x))))));
  }
  return x;
}

// As the authors' program has it: the values are placed too, and the norms come after the sums.
Tensor PotrNet::Decode(DecoderLayer& layer, const Tensor& x, const Tensor& memory) {
  const Tensor placed = layer.norm1(x) + Positions(config_.future_frames);
  const Tensor s = layer.norm2(x + Drop(layer.self->forward(placed, placed, placed)));
  const Tensor c = layer.norm3(s + Drop(layer.cross->forward(s, memory, memory)));
  const Tensor said = Drop(layer.down(Drop(torch::relu(layer.up(c)))));
  return config_.residual ? c + said : said;
}

std::vector<Tensor> PotrNet::ByLayer(const Tensor& past) {
  const int64_t last = config_.past_frames - 1;
  const Tensor embedded = Embed(past);
  const Tensor memory = Encode(embedded.slice(1, 0, last)), query = past.slice(1, last);
  Tensor x = embedded.slice(1, last).expand({-1, config_.future_frames, -1});
  std::vector<Tensor> answers;
  for (DecoderLayer& layer : decoder_) {
    x = Decode(layer, x, memory);
    answers.push_back(pose_(x) + query);
  }
  return answers;
}

Tensor PotrNet::Loss(const PoseTensors& windows) {
  const Tensor rows = columns().Encode(windows, config_.past_frames);
  const Tensor target = rows.slice(1, config_.past_frames);
  Tensor total = torch::zeros({});
  for (const Tensor& answer : ByLayer(rows.slice(1, 0, config_.past_frames))) {
    total = total + MeanRecorded(windows, (answer - target).abs().mean(-1));
  }
  return total / config_.layers;
}

}  // namespace poise::prediction
