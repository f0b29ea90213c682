#include "core/prediction/rnn/rnn_net.h"

namespace poise::prediction {

using torch::Tensor;

RnnNet::RnnNet(const RnnConfig& config, const NetworkBody& body, const EulerMeasure& measure)
    : ColumnNet(config.past_frames, config.future_frames,
                {.root = config.root, .moving = false, .normalised = config.normalised}, body,
                measure),
      config_(config) {
  const int64_t count = columns().count();
  cell_ = register_module("cell", torch::nn::GRUCell(count, config.hidden));
  change_ = register_module("change", torch::nn::Linear(config.hidden, count));
}

Tensor RnnNet::Forward(const Tensor& past) {
  const int64_t last = config_.past_frames - 1;
  Tensor state = torch::zeros({past.size(0), config_.hidden});
  for (int64_t frame = 0; frame < last; ++frame) state = cell_(past.select(1, frame), state);
  Tensor pose = past.select(1, last);
  std::vector<Tensor> answers;
  for (int frame = 0; frame < config_.future_frames; ++frame) {
    state = cell_(pose, state);
    answers.push_back(pose + change_(state));
    pose = answers.back().detach();
  }
  return torch::stack(answers, 1);
}

Tensor RnnNet::Loss(const PoseTensors& windows) {
  const Tensor rows = columns().Encode(windows, config_.past_frames);
  const Tensor error =
      Forward(rows.slice(1, 0, config_.past_frames)) - rows.slice(1, config_.past_frames);
  return MeanRecorded(windows, config_.squared ? error.square().mean(-1) : error.abs().sum(-1));
}

}  // namespace poise::prediction
