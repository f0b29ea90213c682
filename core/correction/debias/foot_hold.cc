#include "core/correction/debias/foot_hold.h"

#include <algorithm>

#include "core/correction/preparation/foot_track.h"
#include "core/correction/preparation/leg_bend.h"
#include "core/math/low_pass.h"
#include "core/math/slerp.h"

namespace poise::correction {
namespace {

using Feet = std::array<FootTrack, 2>;

constexpr double kDropCutoffHz = 6;

// How far a foot follows the debiased motion, 0 to 1: by the lower of its two soles.
double Freedom(const FootTrack& imitated, const FootTrack& debiased, int frame,
               const FootHold& hold) {
  const double height = std::min(imitated.heights[frame], debiased.heights[frame]);
  const double u =
      std::clamp((height - hold.low_m) / std::max(hold.high_m - hold.low_m, 1e-9), 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

FootTarget Between(const FootTrack& imitated, const FootTrack& debiased, int frame, double free) {
  return {.ankle = (1 - free) * imitated.ankles[frame] + free * debiased.ankles[frame],
          .rotation = math::SlerpAt(free)(imitated.rotations[frame], debiased.rotations[frame])};
}

}  // namespace

motion::Clip HoldFeet(motion::Clip debiased, const motion::Clip& imitated,
                      const physics::HumanoidModel& body, const FootHold& hold) {
  const Feet was = TrackFeet(imitated, body), is = TrackFeet(debiased, body);
  const int frames = debiased.num_frames();
  std::array<std::vector<FootTarget>, 2> targets;
  std::array<std::vector<double>, 2> freedom;
  std::vector<double> drop(frames, 0.0);
  for (int side = 0; side < 2; ++side) {
    for (int f = 0; f < frames; ++f) {
      const double free = Freedom(was[side], is[side], f, hold);
      freedom[side].push_back(free);
      targets[side].push_back(Between(was[side], is[side], f, free));
      drop[f] = std::max(
          drop[f], (1 - free) * DropToReach(debiased, f, is[side], targets[side].back().ankle));
    }
  }
  // Smoothed, a drop would be too small at its deepest: what is missing there the feet lose.
  std::vector<double> smooth = drop;
  math::LowPassZeroPhase(smooth, debiased.frame_rate(), kDropCutoffHz);
  for (int f = 0; f < frames; ++f) {
    debiased.root_position(f).y() -= std::max(drop[f], smooth[f]);
    for (int side = 0; side < 2; ++side) {
      if (freedom[side][f] < 1 || drop[f] > 0 || smooth[f] > 0) {
        BendLeg(targets[side][f], f, is[side], debiased);
      }
    }
  }
  return debiased;
}

}  // namespace poise::correction
