#include "core/prediction/gcn/gcn_net.h"

#include <fmt/format.h>

#include <cmath>

#include "core/prediction/tensors/dct.h"
#include "core/prediction/tensors/rotation_tensors.h"

namespace poise::prediction {

using torch::Tensor;

GcnNet::GcnNet(const GcnConfig& config, const NetworkBody& body, const EulerMeasure& measure)
    : config_(config),
      joints_(torch::tensor(std::vector<int64_t>(body.joints.begin(), body.joints.end()))),
      columns_(measure.counts.nonzero().flatten()) {
  sense_ = register_buffer("sense", torch::full({1}, measure.row_vectors ? -1.0F : 1.0F));
  counts_ = register_buffer("counts", measure.counts.clone());
  dct_ = register_buffer("dct", DctMatrix(config_.frames()));
  const int64_t nodes = columns_.size(0), width = config_.width, frames = config_.frames();
  for (int i = 0; i < config_.layers(); ++i) {
    const bool last = i == config_.layers() - 1;
    const int64_t outputs = last ? frames : width;
    const double most = 1 / std::sqrt(static_cast<double>(outputs));
    const auto uniform = [&](const char* name, std::vector<int64_t> shape) {
      return register_parameter(fmt::format("layer{}_{}", i, name),
                                torch::empty(shape).uniform_(-most, most));
    };
    Layer& layer = layers_.emplace_back();
    layer.graph = uniform("graph", {nodes, nodes});
    layer.weight = uniform("weight", {i == 0 ? frames : width, outputs});
    layer.bias = uniform("bias", {outputs});
    if (last) break;
    layer.norm =
        register_module(fmt::format("layer{}_norm", i), torch::nn::BatchNorm1d(nodes * width));
  }
}

Tensor GcnNet::Vectors(const Tensor& rotations) const {
  return sense_ * LogMap(rotations.index_select(2, joints_)).flatten(2);
}

Tensor GcnNet::Padded(const Tensor& vectors) const {
  const int64_t past = config_.past_frames;
  return torch::cat({vectors.slice(1, 0, past),
                     vectors.slice(1, past - 1, past).expand({-1, config_.future_frames, -1})},
                    1)
      .index_select(2, columns_);
}

Tensor GcnNet::Convolve(const Layer& layer, const Tensor& x) const {
  return torch::matmul(layer.graph, torch::matmul(x, layer.weight)) + layer.bias;
}

Tensor GcnNet::Bend(Layer& layer, const Tensor& x) {
  const Tensor y = Convolve(layer, x);
  return torch::dropout(layer.norm(y.flatten(1)).view_as(y).tanh(), config_.dropout, is_training());
}

Tensor GcnNet::Forward(const Tensor& motion) {
  const Tensor x = torch::matmul(dct_, motion).transpose(1, 2);
  Tensor h = Bend(layers_.front(), x);
  for (int block = 0; block < config_.blocks; ++block) {
    h = h + Bend(layers_[2 * block + 2], Bend(layers_[2 * block + 1], h));
  }
  return torch::matmul(dct_.t(), (Convolve(layers_.back(), h) + x).transpose(1, 2));
}

Tensor GcnNet::Loss(const PoseTensors& windows) {
  const Tensor vectors = Vectors(windows.rotations);
  Tensor error = (Forward(Padded(vectors)) - vectors.index_select(2, columns_)).abs().sum(-1);
  if (windows.recorded.defined()) error = error * windows.recorded;
  return error.mean();
}

PoseTensors GcnNet::Predict(const PoseTensors& windows) {
  const int64_t past = config_.past_frames, future = config_.future_frames;
  const Tensor vectors = Vectors(windows.rotations.slice(1, 0, past));
  Tensor answer = vectors.slice(1, past - 1, past).expand({-1, future, -1}).clone();
  answer.index_copy_(2, columns_, Forward(Padded(vectors)).slice(1, past));
  Tensor rotations =
      windows.rotations.slice(1, past - 1, past).expand({-1, future, -1, -1}).clone();
  rotations.index_copy_(2, joints_, ExpMap((sense_ * answer).unflatten(2, {joints_.size(0), 3})));
  return {rotations, windows.positions.slice(1, past - 1, past).expand({-1, future, -1})};
}

}  // namespace poise::prediction
