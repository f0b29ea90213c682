#include "core/prediction/zero_velocity/zero_velocity.h"

namespace poise::prediction {

StatusOr<std::vector<motion::Clip>> ZeroVelocity::Predict(std::span<const Observation> batch,
                                                          int future_frames,
                                                          const base::RunContext& context) const {
  POISE_RETURN_IF_ERROR(CheckObservations(signature_, batch, future_frames));
  std::vector<motion::Clip> futures;
  for (const auto& [past, visible] : batch) {
    POISE_RETURN_IF_ERROR(context.Check());
    const int last = past.num_frames() - 1;
    std::vector<motion::Quat> rotations;
    rotations.reserve(static_cast<size_t>(future_frames) * past.num_joints());
    for (int frame = 0; frame < future_frames; ++frame) {
      rotations.insert(rotations.end(), past.pose(last).begin(), past.pose(last).end());
    }
    POISE_ASSIGN_OR_RETURN(
        motion::Clip future,
        motion::Clip::Create(past.name(), past.skeleton(), past.frame_rate(),
                             std::vector<motion::Vec3>(future_frames, past.root_position(last)),
                             std::move(rotations)));
    futures.push_back(std::move(future));
  }
  return futures;
}

}  // namespace poise::prediction
