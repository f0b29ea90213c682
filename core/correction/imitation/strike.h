#ifndef POISE_CORE_CORRECTION_IMITATION_STRIKE_H_
#define POISE_CORE_CORRECTION_IMITATION_STRIKE_H_

#include <span>
#include <vector>

#include "core/base/config_fields.h"
#include "core/correction/imitation/policy_rollout.h"

namespace poise::correction {

/// DeepMimic's additional task, the baseline that MotionAug compares its variants with: a limb is
/// to strike a target while the body imitates the one motion there is. Reward: (1 - weight) *
/// imitation + weight * strike. Source: MotionAug sec. 4.4, Eq. 1 (weights 0.3 and 0.7); the strike
/// reward is DeepMimic's (Peng et al. 2018, sec. 6).
struct StrikeConfig {
  double weight = 0.3;        ///< [0 to 1] beta of the paper; alpha is the rest
  double scale = 4;           ///< [1/m2, >= 0] of the squared distance
  double hit_radius_m = 0.2;  ///< [m, >= 0] so near to the target it is struck

  std::vector<base::Field> Fields();
};

/// 1 once the target has been struck, exp(-scale * distance^2) until then.
double StrikeReward(const StrikeConfig& config, double distance_m, bool struck);

/// How one episode's strike goes.
class Strike {
 public:
  /// What it adds to an observation, in the frame of the reference's heading: the target from the
  /// reference's pelvis (3) and from the limb (3); whether it has been struck (1).
  static constexpr int kObservationSize = 7;

  /// `body` strikes with its joint: an ankle, a wrist. `target` is in the world [m].
  Strike(const StrikeConfig& config, int body, const Vec3& target)
      : config_(config), body_(body), target_(target) {}

  /// Looks where the limb is now. observation: (kObservationSize)
  void Observe(const TrackingEpisode& episode, const ReferenceMotion& reference,
               std::span<float> observation);
  /// The same as what a policy that is played sees; refers to both.
  ExtraObservation Extra(const ReferenceMotion& reference);
  /// Of the last look.
  double Reward() const { return StrikeReward(config_, distance_m_, struck_); }
  double distance_m() const { return distance_m_; }
  bool struck() const { return struck_; }

 private:
  StrikeConfig config_;
  int body_;
  Vec3 target_;
  double distance_m_ = 0;
  bool struck_ = false;
};

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_IMITATION_STRIKE_H_
