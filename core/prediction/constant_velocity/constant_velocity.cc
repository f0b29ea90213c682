#include "core/prediction/constant_velocity/constant_velocity.h"

namespace poise::prediction {
namespace {

using motion::Quat;
using motion::Vec3;

StatusOr<motion::Clip> Extrapolate(const motion::Clip& past, int future_frames) {
  const int last = past.num_frames() - 1;
  const Vec3 step = past.root_position(last) - past.root_position(last - 1);
  std::vector<Vec3> turns;  // per joint and frame, in the joint's own frame
  for (int joint = 0; joint < past.num_joints(); ++joint) {
    turns.push_back(math::ToRotationVector(past.rotation(last - 1, joint).conjugate() *
                                           past.rotation(last, joint)));
  }
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
  for (int frame = 1; frame <= future_frames; ++frame) {
    positions.push_back(past.root_position(last) + frame * step);
    for (int joint = 0; joint < past.num_joints(); ++joint) {
      rotations.push_back(past.rotation(last, joint) *
                          math::FromRotationVector(frame * turns[joint]));
    }
  }
  return motion::Clip::Create(past.name(), past.skeleton(), past.frame_rate(), std::move(positions),
                              std::move(rotations));
}

}  // namespace

StatusOr<std::vector<motion::Clip>> ConstantVelocity::Predict(
    std::span<const Observation> batch, int future_frames, const base::RunContext& context) const {
  POISE_RETURN_IF_ERROR(CheckObservations(signature_, batch, future_frames));
  std::vector<motion::Clip> futures;
  for (const Observation& observation : batch) {
    POISE_RETURN_IF_ERROR(context.Check());
    POISE_ASSIGN_OR_RETURN(motion::Clip future, Extrapolate(observation.past, future_frames));
    futures.push_back(std::move(future));
  }
  return futures;
}

}  // namespace poise::prediction
