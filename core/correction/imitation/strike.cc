#include "core/correction/imitation/strike.h"

#include <algorithm>
#include <cmath>

#include "core/correction/reward.h"

namespace poise::correction {

std::vector<base::Field> StrikeConfig::Fields() {
  return {
      base::Number("weight", &weight, 0, 1),
      base::Number("scale", &scale, 0, 1e6),
      base::Number("hit_radius_m", &hit_radius_m, 0, 10),
  };
}

double StrikeReward(const StrikeConfig& config, double distance_m, bool struck) {
  return struck ? 1 : std::exp(-config.scale * distance_m * distance_m);
}

void Strike::Observe(const TrackingEpisode& episode, const ReferenceMotion& reference,
                     std::span<float> observation) {
  const int frame = std::min(episode.frame(), reference.num_frames() - 1);
  const physics::State& wanted = reference.frame(frame);
  const Vec3 limb = physics::ComputeFrames(episode.model().articulation(), episode.world().state())
                        .positions[body_];
  distance_m_ = (target_ - limb).norm();
  struck_ = struck_ || distance_m_ <= config_.hit_radius_m;
  const Quat heading = HeadingInverse(wanted.rotations[0]);
  const Vec3 from_pelvis = heading * (target_ - wanted.root_position);
  const Vec3 from_limb = heading * (target_ - limb);
  for (int k = 0; k < 3; ++k) {
    observation[k] = static_cast<float>(from_pelvis[k]);
    observation[3 + k] = static_cast<float>(from_limb[k]);
  }
  observation[6] = struck_ ? 1 : 0;
}

ExtraObservation Strike::Extra(const ReferenceMotion& reference) {
  return {.size = kObservationSize,
          .observe = [this, &reference](const TrackingEpisode& episode, std::span<float> out) {
            Observe(episode, reference, out);
          }};
}

}  // namespace poise::correction
