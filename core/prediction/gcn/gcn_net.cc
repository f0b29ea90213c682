#include "core/prediction/gcn/gcn_net.h"

#include <fmt/format.h>

#include "core/prediction/tensors/dct.h"

namespace poise::prediction {

using torch::Tensor;

GcnNet::GcnNet(const GcnConfig& config, const NetworkBody& body, const EulerMeasure& measure)
    : ColumnNet(config.past_frames, config.future_frames,
                {.root = config.root, .moving = config.moving, .normalised = false}, body, measure),
      config_(config) {
  const int kept = config.kept_coefficients();
  dct_ = register_buffer("dct", DctMatrix(config.frames()).slice(0, 0, kept).contiguous());
  for (int i = 0; i < config.layers(); ++i) {
    const bool last = i == config.layers() - 1;
    layers_.push_back(register_module(fmt::format("layer{}", i),
                                      std::make_shared<GraphConvolution>(GraphConvolutionOptions{
                                          .nodes = columns().count(),
                                          .inputs = i == 0 ? kept : config.width,
                                          .outputs = last ? kept : config.width,
                                          .bent = !last,
                                          .dropout = config.dropout})));
  }
}

Tensor GcnNet::AllFrames(const Tensor& past) {
  const int64_t last = config_.past_frames - 1;
  const Tensor padded =
      torch::cat({past, past.slice(1, last).expand({-1, config_.future_frames, -1})}, 1);
  const Tensor x = torch::matmul(dct_, padded).transpose(1, 2);
  Tensor h = layers_.front()->forward(x);
  for (int block = 0; block < config_.blocks; ++block) {
    h = h + layers_[2 * block + 2]->forward(layers_[2 * block + 1]->forward(h));
  }
  return torch::matmul(dct_.t(), (layers_.back()->forward(h) + x).transpose(1, 2));
}

Tensor GcnNet::Forward(const Tensor& past) { return AllFrames(past).slice(1, past.size(1)); }

Tensor GcnNet::Loss(const PoseTensors& windows) {
  const Tensor rows = columns().Encode(windows, config_.past_frames);
  const Tensor answer = AllFrames(rows.slice(1, 0, config_.past_frames));
  return MeanRecorded(windows, (answer - rows).abs().sum(-1));
}

}  // namespace poise::prediction
