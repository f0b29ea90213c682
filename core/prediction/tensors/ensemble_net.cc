#include "core/prediction/tensors/ensemble_net.h"

#include <fmt/format.h>

namespace poise::prediction {

using torch::Tensor;

EnsembleNet::EnsembleNet(std::vector<std::shared_ptr<PredictorNet>> members)
    : members_(std::move(members)) {
  for (size_t i = 0; i < members_.size(); ++i) {
    register_module(fmt::format("member{}", i), members_[i]);
  }
}

void EnsembleNet::Fit(const PoseTensors& windows) {
  for (const auto& member : members_) member->Fit(windows);
}

Tensor EnsembleNet::Loss(const PoseTensors& windows) {
  const int64_t part = windows.rotations.size(0) / static_cast<int64_t>(members_.size());
  Tensor total = torch::zeros({});
  for (size_t i = 0; i < members_.size(); ++i) {
    const int64_t first = static_cast<int64_t>(i) * part;
    PoseTensors own{windows.rotations.slice(0, first, first + part),
                    windows.positions.slice(0, first, first + part)};
    if (windows.recorded.defined()) own.recorded = windows.recorded.slice(0, first, first + part);
    total = total + members_[i]->Loss(own);
  }
  return total;
}

PoseTensors EnsembleNet::Predict(const PoseTensors& windows) {
  PoseTensors mean = members_.front()->Predict(windows);
  for (size_t i = 1; i < members_.size(); ++i) {
    const PoseTensors more = members_[i]->Predict(windows);
    const Tensor side = (mean.rotations * more.rotations).sum(-1, true) < 0;
    mean.rotations = mean.rotations + torch::where(side, -more.rotations, more.rotations);
    mean.positions = mean.positions + more.positions;
  }
  return {mean.rotations / mean.rotations.norm(2, -1, true),
          mean.positions / static_cast<double>(members_.size())};
}

}  // namespace poise::prediction
