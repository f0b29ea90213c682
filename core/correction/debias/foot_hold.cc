#include "core/correction/debias/foot_hold.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/correction/preparation/foot_track.h"
#include "core/correction/preparation/leg_bend.h"
#include "core/math/low_pass.h"
#include "core/math/slerp.h"

namespace poise::correction {
namespace {

using Feet = std::array<FootTrack, 2>;

constexpr double kEnvelopeCutoffHz = 5;
constexpr double kEnvelopeReach = 0.1;  // [s] about what the low-pass spreads over

// A smooth curve that is hardly ever below the values.
std::vector<double> Envelope(const std::vector<double>& values, double frame_rate) {
  const int frames = static_cast<int>(values.size());
  const int reach = static_cast<int>(std::lround(kEnvelopeReach * frame_rate));
  std::vector<double> envelope;
  for (int f = 0; f < frames; ++f) {
    const auto first = values.begin() + std::max(f - reach, 0);
    envelope.push_back(*std::max_element(first, values.begin() + std::min(f + reach + 1, frames)));
  }
  math::LowPassZeroPhase(envelope, frame_rate, kEnvelopeCutoffHz);
  return envelope;
}

// How far a foot follows the debiased motion, 0 to 1: by the lower of its two soles.
std::vector<double> Freedom(const FootTrack& imitated, const FootTrack& debiased,
                            const FootHold& hold, double frame_rate) {
  std::vector<double> held;
  for (int f = 0; f < imitated.num_frames(); ++f) {
    const double height = std::min(imitated.heights[f], debiased.heights[f]);
    const double u = (height - hold.low_m) / std::max(hold.high_m - hold.low_m, 1e-9);
    held.push_back(1 - std::clamp(u, 0.0, 1.0));
  }
  std::vector<double> free;
  for (const double value : Envelope(held, frame_rate)) {
    free.push_back(1 - std::clamp(value, 0.0, 1.0));
  }
  return free;
}

// The root goes the debiased way as far as both feet do.
void HoldRoot(const std::array<std::vector<double>, 2>& freedom, const motion::Clip& imitated,
              motion::Clip& debiased) {
  for (int f = 0; f < debiased.num_frames(); ++f) {
    const Vec3 way = debiased.root_position(f) - imitated.root_position(f);
    debiased.root_position(f) =
        imitated.root_position(f) + std::min(freedom[0][f], freedom[1][f]) * way;
  }
}

FootTarget Between(const FootTrack& imitated, const FootTrack& debiased, int frame, double free) {
  return {.ankle = (1 - free) * imitated.ankles[frame] + free * debiased.ankles[frame],
          .rotation = math::SlerpAt(free)(imitated.rotations[frame], debiased.rotations[frame])};
}

}  // namespace

motion::Clip HoldFeet(motion::Clip debiased, const motion::Clip& imitated,
                      const physics::HumanoidModel& body, const FootHold& hold) {
  const Feet was = TrackFeet(imitated, body);
  Feet is = TrackFeet(debiased, body);
  std::array<std::vector<double>, 2> freedom;
  for (int side = 0; side < 2; ++side) {
    freedom[side] = Freedom(was[side], is[side], hold, imitated.frame_rate());
  }
  if (hold.root) {
    HoldRoot(freedom, imitated, debiased);
    is = TrackFeet(debiased, body);
  }
  const int frames = debiased.num_frames();
  std::array<std::vector<FootTarget>, 2> targets;
  std::vector<double> drop(frames, 0.0);
  for (int side = 0; side < 2; ++side) {
    for (int f = 0; f < frames; ++f) {
      const double free = freedom[side][f];
      targets[side].push_back(Between(was[side], is[side], f, free));
      drop[f] = std::max(
          drop[f], (1 - free) * DropToReach(debiased, f, is[side], targets[side].back().ankle));
    }
  }
  drop = Envelope(drop, imitated.frame_rate());
  for (int f = 0; f < frames; ++f) {
    debiased.root_position(f).y() -= drop[f];
    for (int side = 0; side < 2; ++side) {
      if (freedom[side][f] < 1 || drop[f] != 0) BendLeg(targets[side][f], f, is[side], debiased);
    }
  }
  return debiased;
}

}  // namespace poise::correction
