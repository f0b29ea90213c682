#ifndef POISE_CORE_PUSH_PUSH_FORECASTER_H_
#define POISE_CORE_PUSH_PUSH_FORECASTER_H_

#include <memory>
#include <string>
#include <vector>

#include "core/artifacts/model_artifact.h"
#include "core/base/config_fields.h"
#include "core/base/status.h"
#include "core/push/push_scene.h"

namespace poise::push {

/// One frame of a forecast, of all people; ground frame.
struct PushFrame {
  int frame = 0;
  PendulumStates states;
  PendulumArray interaction;      ///< (people, 4) generalised forces between people [N, N m]
  Eigen::ArrayX3d hips;           ///< (people, 3) [m]
  std::vector<int> onset_frames;  ///< (people) of the first movement; -1: not yet
  std::vector<BodyTurns> turns;   ///< (people) since frame 0; empty: bodies keep their pose
};

/// A forecast under way. Threads: one caller at a time.
class PushRollout {
 public:
  virtual ~PushRollout() = default;
  /// The next frame, from frame 0 on; valid until the next call. Nothing ends it: the scene's
  /// number of frames is for the caller. Errors: kInternal NOT_FINITE.
  virtual StatusOr<const PushFrame*> Next() = 0;
};

/// Forecasts what people do after a push. Constant and shared.
/// Threads: all members may be called from any thread.
class PushForecaster {
 public:
  virtual ~PushForecaster() = default;
  virtual std::unique_ptr<PushRollout> Start(const PushScene& scene) const = 0;
};

/// Pendulums under hand-made balance and contact; bodies keep their pose and move as statues.
/// Errors: kInvalidArgument, those of base::ApplyOverrides for PhysicsConfig.
StatusOr<std::unique_ptr<PushForecaster>> MakeStatueForecaster(const base::Overrides& overrides);

/// What the card of a trained push model has as its family.
inline constexpr const char* kModelFamily = "push";

/// Networks that learned from recorded pushes (core/push/training): hips go as the mean of an
/// ensemble, and pose networks move bodies. Each person is forecast in a frame along the push
/// (learned/reaction_watch.h says whose), so place and direction do not matter.
/// Errors: kFailedPrecondition WRONG_FAMILY; kInvalidArgument MISSING_TENSOR, WRONG_SHAPE; config
/// errors.
StatusOr<std::unique_ptr<PushForecaster>> MakeLearnedForecaster(
    const artifacts::ModelArtifact& model);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_PUSH_FORECASTER_H_
