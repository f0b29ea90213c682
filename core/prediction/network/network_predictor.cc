#include "core/prediction/network/network_predictor.h"

#include <fmt/format.h>

#include <utility>

namespace poise::prediction {

using motion::Clip;

NetworkPredictor::NetworkPredictor(NetworkBody body, int past_frames, int future_frames)
    : body_(std::move(body)),
      signature_{.skeleton = body_.skeleton,
                 .frame_rate = body_.frame_rate,
                 .past_frames = past_frames,
                 .max_future_frames = future_frames} {}

StatusOr<Clip> NetworkPredictor::ToClip(const Clip& past, const float* outputs,
                                        int future_frames) const {
  const int last = past.num_frames() - 1;
  FuturePoses future{
      .joints = past.num_joints(),
      .root_positions = std::vector<motion::Vec3>(future_frames, past.root_position(last)),
      .rotations = {}};
  future.rotations.reserve(static_cast<size_t>(future_frames) * past.num_joints());
  for (int frame = 0; frame < future_frames; ++frame) {
    future.rotations.insert(future.rotations.end(), past.pose(last).begin(), past.pose(last).end());
  }
  Decode(past, outputs, future);
  StatusOr<Clip> clip = Clip::Create(past.name(), past.skeleton(), past.frame_rate(),
                                     std::move(future.root_positions), std::move(future.rotations));
  if (clip.ok()) return clip;
  return base::Internal("NOT_FINITE",
                        fmt::format("clip '{}': the network's answer is no motion: {}", past.name(),
                                    base::Message(clip.status())));
}

StatusOr<std::vector<Clip>> NetworkPredictor::Predict(std::span<const Observation> batch,
                                                      int future_frames,
                                                      const base::RunContext& context) const {
  POISE_RETURN_IF_ERROR(CheckObservations(signature_, batch, future_frames));
  POISE_RETURN_IF_ERROR(context.Check());
  const Sizes size = sizes();
  std::vector<float> inputs(batch.size() * size.inputs), outputs(batch.size() * size.outputs);
  for (size_t i = 0; i < batch.size(); ++i) {
    Encode(batch[i].past, inputs.data() + i * size.inputs);
  }
  Forward(static_cast<int>(batch.size()), inputs.data(), outputs.data());
  std::vector<Clip> futures;
  futures.reserve(batch.size());
  for (size_t i = 0; i < batch.size(); ++i) {
    POISE_ASSIGN_OR_RETURN(Clip clip,
                           ToClip(batch[i].past, outputs.data() + i * size.outputs, future_frames));
    futures.push_back(std::move(clip));
  }
  return futures;
}

}  // namespace poise::prediction
