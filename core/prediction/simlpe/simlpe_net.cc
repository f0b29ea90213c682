#include "core/prediction/simlpe/simlpe_net.h"

#include <fmt/format.h>

#include "core/prediction/tensors/dct.h"

namespace poise::prediction {
namespace {

using torch::Tensor;
using torch::nn::Linear;

constexpr double kFirstGain = 1e-8;

void Quieten(Linear& linear) {
  torch::nn::init::xavier_uniform_(linear->weight, kFirstGain);
  torch::nn::init::zeros_(linear->bias);
}

Tensor Changes(const Tensor& rows) { return rows.slice(1, 1) - rows.slice(1, 0, -1); }

}  // namespace

SimlpeNet::SimlpeNet(const SimlpeConfig& config, const NetworkBody& body,
                     const EulerMeasure& measure)
    : ColumnNet(config.past_frames, config.future_frames,
                {.root = config.root, .moving = false, .normalised = true}, body, measure),
      config_(config) {
  const int64_t count = columns().count(), past = config.past_frames;
  dct_ = register_buffer("dct", DctMatrix(config.past_frames));
  in_ = register_module("in", Linear(count, count));
  for (int i = 0; i < config.blocks; ++i) {
    Block& block = blocks_.emplace_back();
    block.along_time = register_module(fmt::format("block{}_time", i), Linear(past, past));
    block.norm = register_module(fmt::format("block{}_norm", i),
                                 torch::nn::LayerNorm(std::vector<int64_t>{count}));
    Quieten(block.along_time);
  }
  out_ = register_module("out", Linear(count, count));
  Quieten(out_);
}

Tensor SimlpeNet::Forward(const Tensor& past) {
  Tensor h = in_(torch::matmul(dct_, past));
  for (Block& block : blocks_) {
    h = h + block.norm(block.along_time(h.transpose(1, 2)).transpose(1, 2));
  }
  const Tensor changes = torch::matmul(dct_.t(), out_(h));
  return changes.slice(1, 0, config_.future_frames) + past.slice(1, config_.past_frames - 1);
}

Tensor SimlpeNet::Loss(const PoseTensors& windows) {
  const Tensor rows = columns().Encode(windows, config_.past_frames);
  const Tensor target = rows.slice(1, config_.past_frames);
  const Tensor answer = Forward(rows.slice(1, 0, config_.past_frames));
  return MeanRecorded(windows, (answer - target).abs().mean(-1)) +
         MeanRecorded(windows, (Changes(answer) - Changes(target)).abs().mean(-1));
}

}  // namespace poise::prediction
