#include "core/prediction/predictor.h"

#include <fmt/format.h>

#include <cmath>

namespace poise::prediction {
namespace {

constexpr double kSameRate = 1e-6;  // relative

Status CheckPast(const PredictorSignature& signature, const motion::Clip& past) {
  if (past.num_frames() < signature.past_frames) {
    return base::InvalidArgument(
        "TOO_FEW_FRAMES", "past",
        fmt::format("clip '{}' has {} frames, the model needs {}", past.name(), past.num_frames(),
                    signature.past_frames));
  }
  if (signature.skeleton != nullptr && past.skeleton() != signature.skeleton &&
      past.num_joints() != signature.skeleton->num_joints()) {
    return base::InvalidArgument("WRONG_SKELETON", "past",
                                 fmt::format("clip '{}' has {} joints, the model {}", past.name(),
                                             past.num_joints(), signature.skeleton->num_joints()));
  }
  if (signature.frame_rate > 0 &&
      std::abs(past.frame_rate() / signature.frame_rate - 1) > kSameRate) {
    return base::InvalidArgument("WRONG_FRAME_RATE", "past",
                                 fmt::format("clip '{}' is at {} Hz, the model at {} Hz",
                                             past.name(), past.frame_rate(), signature.frame_rate));
  }
  return absl::OkStatus();
}

Status CheckMask(const PredictorSignature& signature, const Observation& observation) {
  if (observation.visible.empty()) return absl::OkStatus();
  const size_t expected = observation.past.rotations().size();
  if (observation.visible.visible.size() != expected) {
    return base::InvalidArgument(
        "WRONG_SHAPE", "visible",
        fmt::format("the mask has {} entries, expected {} frames x {} joints",
                    observation.visible.visible.size(), observation.past.num_frames(),
                    observation.past.num_joints()));
  }
  if (signature.takes_masks) return absl::OkStatus();
  return base::InvalidArgument("MASKS_NOT_SUPPORTED", "visible",
                               "this model needs every joint of every frame");
}

}  // namespace

Status CheckObservations(const PredictorSignature& signature, std::span<const Observation> batch,
                         int future_frames) {
  if (future_frames < 1) {
    return base::InvalidArgument("BAD_HORIZON", "horizon",
                                 fmt::format("{} future frames asked for", future_frames));
  }
  if (signature.max_future_frames > 0 && future_frames > signature.max_future_frames) {
    return base::InvalidArgument(
        "HORIZON_TOO_LONG", "horizon",
        fmt::format("{} future frames asked for, the model makes at most {}", future_frames,
                    signature.max_future_frames));
  }
  for (size_t i = 0; i < batch.size(); ++i) {
    Status status = CheckPast(signature, batch[i].past);
    if (status.ok()) status = CheckMask(signature, batch[i]);
    if (!status.ok()) {
      const std::string field = fmt::format("observations[{}]", i);
      return base::Annotate(status, field, field);
    }
  }
  return absl::OkStatus();
}

}  // namespace poise::prediction
