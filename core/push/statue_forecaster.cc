#include "core/push/onset_watch.h"
#include "core/push/pendulum/crowd.h"
#include "core/push/push_forecaster.h"

namespace poise::push {
namespace {

class StatueRollout : public PushRollout {
 public:
  StatueRollout(const PushScene& scene, const PhysicsConfig& config)
      : scene_(scene), crowd_(scene, config), onsets_(static_cast<int>(scene.people.size())) {}

  StatusOr<const PushFrame*> Next() override {
    if (next_ > 0) crowd_.Step(PushForces(scene_, next_ - 1, crowd_.states()));
    onsets_.Observe(next_, RodEndVelocities(crowd_.states()));
    frame_ = {.frame = next_++,
              .states = crowd_.states(),
              .interaction = crowd_.interaction(),
              .hips = crowd_.hips(),
              .onset_frames = onsets_.onset_frames(),
              .turns = {}};
    if (!frame_.hips.allFinite()) {
      return base::Internal("NOT_FINITE", "the pendulums left the range of numbers");
    }
    return &frame_;
  }

 private:
  const PushScene scene_;
  Crowd crowd_;
  OnsetWatch onsets_;
  PushFrame frame_;
  int next_ = 0;
};

class StatueForecaster : public PushForecaster {
 public:
  explicit StatueForecaster(const PhysicsConfig& config) : config_(config) {}

  std::unique_ptr<PushRollout> Start(const PushScene& scene) const override {
    return std::make_unique<StatueRollout>(scene, config_);
  }

 private:
  const PhysicsConfig config_;
};

}  // namespace

StatusOr<std::unique_ptr<PushForecaster>> MakeStatueForecaster(const base::Overrides& overrides) {
  PhysicsConfig config;
  POISE_RETURN_IF_ERROR(base::ApplyOverrides(overrides, base::Nested("physics", config.Fields())));
  POISE_RETURN_IF_ERROR(base::CheckRanges(base::Nested("physics", config.Fields())));
  return std::make_unique<StatueForecaster>(config);
}

}  // namespace poise::push
