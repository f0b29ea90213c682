#include "core/correction/imitation/policy_rollout.h"

#include <vector>

namespace poise::correction {

Commander PolicyCommander(const ImitationSpaces& spaces, const ImitationConfig& config,
                          const ReferenceMotion& reference, const rl::Policy& policy,
                          const ExtraObservation& extra) {
  return [&spaces, &reference, extra, actor = rl::Policy(policy),
          hold = FramesPerAction(config, reference.frame_rate()),
          observation = std::vector<float>(spaces.observation_size() + extra.size),
          action = std::vector<float>(spaces.action_size()),
          command = FrameCommand()](const TrackingEpisode& episode) mutable {
    if (episode.frame() % hold == 0) {
      const std::span<float> all(observation);
      spaces.Observe(episode, reference, all.first(spaces.observation_size()));
      if (extra.size > 0) extra.observe(episode, all.last(extra.size));
      actor.Act(observation, action);
      command = spaces.Command(action, reference.frame(episode.frame()));
    }
    return command;
  };
}

double Merit(const TrackingScore& score, const ImitationConfig& config) {
  return (score.completed ? 1 : 0) + score.reward_normalised -
         config.force_weight * score.residual_force_mean_bw -
         config.torque_weight * score.residual_torque_mean_nm / kTorqueUnit;
}

}  // namespace poise::correction
