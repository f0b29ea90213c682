#include "core/correction/imitation/policy_rollout.h"

#include <vector>

namespace poise::correction {

Commander PolicyCommander(const ImitationSpaces& spaces, const ImitationConfig& config,
                          const ReferenceMotion& reference, const rl::Policy& policy) {
  return [&spaces, &reference, actor = rl::Policy(policy),
          hold = FramesPerAction(config, reference.frame_rate()),
          observation = std::vector<float>(spaces.observation_size()),
          action = std::vector<float>(spaces.action_size()),
          command = FrameCommand()](const TrackingEpisode& episode) mutable {
    if (episode.frame() % hold == 0) {
      spaces.Observe(episode, reference, observation);
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
