#include "core/correction/debias/debias_net.h"

#include <fmt/format.h>

#include "core/correction/debias/debias_frames.h"

namespace poise::correction {
namespace {

constexpr double kLeak = 0.01;

}  // namespace

DebiasNet::DebiasNet(const DebiasConfig& config)
    : dropout_(register_module("dropout", torch::nn::Dropout(config.dropout))) {
  int inputs = InputWidth(config.input);
  for (int i = 0; i <= config.layers; ++i) {
    const int outputs = i < config.layers ? config.hidden : kCorrectionWidth;
    layers_.push_back(
        register_module(fmt::format("layer{}", i), torch::nn::Linear(inputs, outputs)));
    inputs = outputs;
  }
  torch::nn::init::zeros_(layers_.back()->weight);
  torch::nn::init::zeros_(layers_.back()->bias);
}

torch::Tensor DebiasNet::forward(const torch::Tensor& rows) {
  torch::Tensor out = dropout_->forward(rows);
  for (size_t i = 0; i < layers_.size(); ++i) {
    out = layers_[i]->forward(out);
    if (i + 1 < layers_.size()) out = torch::leaky_relu(out, kLeak);
  }
  return out;
}

torch::Tensor DebiasNet::Penalty(const DebiasConfig& config) const {
  torch::Tensor sum = torch::zeros({});
  for (const torch::nn::Linear& layer : layers_) {
    if (config.l2_weight > 0) {
      sum = sum + config.l2_weight / kCorrectionWidth * layer->weight.square().sum();
    }
    if (config.l1_weight > 0) sum = sum + config.l1_weight * layer->weight.abs().sum();
  }
  return sum;
}

}  // namespace poise::correction
