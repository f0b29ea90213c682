#ifndef POISE_CORE_CORRECTION_IMITATION_POLICY_ROLLOUT_H_
#define POISE_CORE_CORRECTION_IMITATION_POLICY_ROLLOUT_H_

#include <functional>
#include <span>

#include "core/correction/imitation/imitation_spaces.h"
#include "core/correction/tracking/motion_tracker.h"
#include "core/learning/rl/policy.h"

namespace poise::correction {

/// What a task shows beside the imitation, behind ImitationSpaces' observation.
struct ExtraObservation {
  int size = 0;
  std::function<void(const TrackingEpisode&, std::span<float>)> observe;
};

/// A policy as what steers a tracker: it acts every FramesPerAction frames, without noise.
/// Refers to `spaces` and `reference`, which must outlive it.
Commander PolicyCommander(const ImitationSpaces& spaces, const ImitationConfig& config,
                          const ReferenceMotion& reference, const rl::Policy& policy,
                          const ExtraObservation& extra = {});

/// By what policies and corrections are compared: 1 if completed, plus the normalised reward, less
/// the config's weights times the mean residual force and torque.
double Merit(const TrackingScore& score, const ImitationConfig& config);

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_IMITATION_POLICY_ROLLOUT_H_
