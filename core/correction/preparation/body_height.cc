#include "core/correction/preparation/body_height.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/correction/preparation/foot_track.h"
#include "core/correction/preparation/sparse_samples.h"
#include "core/math/low_pass.h"
#include "core/motion/metrics/placed_bodies.h"

namespace poise::correction {
namespace {

constexpr double kStill = 0.5;  // [m/s] a foot slower than this is still

bool IsStill(const FootTrack& foot, int frame, const PreparationConfig& config) {
  return std::hypot(foot.speeds[frame], foot.rises[frame]) < kStill &&
         std::abs(foot.heights[frame]) < config.height_band_m;
}

// Height of the ground that the still feet show. A foot below the floor beside one that stands on
// it has sunk alone.
std::optional<double> GroundHeight(const std::array<FootTrack, 2>& feet, int frame,
                                   const PreparationConfig& config) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const FootTrack& foot : feet) {
    if (!IsStill(foot, frame, config)) continue;
    low = std::min(low, foot.heights[frame]);
    high = std::max(high, foot.heights[frame]);
  }
  if (low > high) return std::nullopt;
  return low >= 0 ? low : std::min(high, 0.0);
}

}  // namespace

motion::Clip StandOnFloor(motion::Clip clip, const physics::HumanoidModel& model,
                          const PreparationConfig& config) {
  const std::array<FootTrack, 2> feet = TrackFeet(clip, model);
  const std::vector<char> flight = FindFlight(clip, model);
  motion::PlacedBodies bodies;
  motion::PlaceBodies(model.shapes(), motion::ForwardKinematics(clip), bodies);
  std::vector<std::optional<double>> known(clip.num_frames());
  for (int f = 0; f < clip.num_frames(); ++f) {
    if (flight[f]) continue;
    known[f] = GroundHeight(feet, f, config);
    // Hands or knees that are on the floor already carry the body.
    if (known[f] && *known[f] > 0) known[f] = std::clamp(bodies.lowest[f], 0.0, *known[f]);
  }
  std::vector<double> ground = FillBetween(known);
  math::LowPassZeroPhase(ground, clip.frame_rate(), config.height_cutoff_hz);
  for (int f = 0; f < clip.num_frames(); ++f) clip.root_position(f).y() -= ground[f];
  return clip;
}

}  // namespace poise::correction
