#include "core/correction/preparation/foot_plant.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/correction/preparation/foot_track.h"
#include "core/correction/preparation/leg_bend.h"
#include "core/correction/preparation/sparse_samples.h"
#include "core/math/low_pass.h"

namespace poise::correction {
namespace {

constexpr double kSmoothHz = 10;          // of a foot's displacement
constexpr double kTouchSoftness = 0.004;  // [m] a corner this much above the lowest carries 1 / e
constexpr double kDropSpread_s = 0.1;     // a drop of the pelvis is ready so much earlier
constexpr double kDropCutoffHz = 3;

constexpr double kSwing = 0.5;      // [m/s] a foot swings from this speed on, wholly at thrice
constexpr double kLowSwing = 0.05;  // [m] below this it swings low, at twice no more

using Path = std::vector<Vec3>;  // (frames) [m]

double MinimumJerk(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10 - 15 * u + 6 * u * u);
}

void Smooth(Path& path, double rate_hz, double cutoff_hz) {
  std::vector<double> channel(path.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (size_t f = 0; f < path.size(); ++f) channel[f] = path[f][axis];
    math::LowPassZeroPhase(channel, rate_hz, cutoff_hz);
    for (size_t f = 0; f < path.size(); ++f) path[f][axis] = channel[f];
  }
}

struct Contact {
  int first, end;  // frames [first, end)
};

std::vector<Contact> ListContacts(const std::vector<char>& standing) {
  std::vector<Contact> contacts;
  for (int f = 0; f < static_cast<int>(standing.size()); ++f) {
    if (!standing[f]) continue;
    if (contacts.empty() || contacts.back().end != f) contacts.push_back({f, f});
    contacts.back().end = f + 1;
  }
  return contacts;
}

// Continues what is known during contacts: before and after each it fades to 0 within `blend`
// frames, or meets the next contact's when that is nearer.
void BlendBetween(const std::vector<Contact>& contacts, int blend, Path& path) {
  const int frames = static_cast<int>(path.size());
  const auto part = [&](int distance) {
    return 1 - MinimumJerk(static_cast<double>(distance) / blend);
  };
  for (int f = 0; f < frames; ++f) {
    const auto next = std::find_if(contacts.begin(), contacts.end(),
                                   [&](const Contact& contact) { return contact.end > f; });
    if (next != contacts.end() && next->first <= f) continue;
    path[f].setZero();
    const bool has_next = next != contacts.end(), has_last = next != contacts.begin();
    const int last = has_last ? std::prev(next)->end - 1 : 0, first = has_next ? next->first : 0;
    if (has_last && has_next && first - last < 2 * blend) {
      const double u = MinimumJerk(static_cast<double>(f - last) / (first - last));
      path[f] = (1 - u) * path[last] + u * path[first];
      continue;
    }
    if (has_last) path[f] += part(f - last) * path[last];
    if (has_next) path[f] += part(first - f) * path[first];
  }
}

// Tilted soles come to lie flat, the less the more they are tilted.
void Flatten(const std::vector<Contact>& contacts, double rate_hz, const PreparationConfig& config,
             FootTrack& foot) {
  Path turns(foot.num_frames(), Vec3::Zero());
  for (const Contact& contact : contacts) {
    for (int f = contact.first; f < contact.end; ++f) {
      const Vec3 turn =
          math::ToRotationVector(math::SwingBetween(foot.rotations[f] * foot.up, Vec3::UnitY()));
      const double tilt = turn.norm() / std::max(config.flat_angle, 1e-9);
      turns[f] = (1 - MinimumJerk(tilt - 1)) * turn;
    }
  }
  BlendBetween(contacts, std::max(1, static_cast<int>(config.blend_s / 2 * rate_hz)), turns);
  Smooth(turns, rate_hz, kSmoothHz);
  for (int f = 0; f < foot.num_frames(); ++f) {
    foot.rotations[f] = math::FromRotationVector(turns[f]) * foot.rotations[f];
    foot.heights[f] = foot.Corner(f, 0).y();
    for (int corner = 1; corner < 4; ++corner) {
      foot.heights[f] = std::min(foot.heights[f], foot.Corner(f, corner).y());
    }
  }
}

// How far what touches the floor slides from one frame to the next.
Vec3 Slide(const FootTrack& foot, int frame) {
  Vec3 sum = Vec3::Zero();
  double weights = 0;
  for (int corner = 0; corner < 4; ++corner) {
    const Vec3 now = foot.Corner(frame, corner), next = foot.Corner(frame + 1, corner);
    const double above = (now.y() + next.y() - foot.heights[frame] - foot.heights[frame + 1]) / 2;
    const double weight = std::exp(-above / kTouchSoftness);
    sum += weight * (next - now);
    weights += weight;
  }
  sum.y() = 0;
  return sum / weights;
}

// Displacement of a foot that keeps what touches in place and on the floor, 0 on average over a
// contact; known during contacts.
Path HoldStill(const std::vector<Contact>& contacts, const FootTrack& foot) {
  Path path(foot.num_frames(), Vec3::Zero());
  for (const Contact& contact : contacts) {
    Vec3 mean = Vec3::Zero();
    for (int f = contact.first; f < contact.end; ++f) {
      if (f > contact.first) path[f] = path[f - 1] - Slide(foot, f - 1);
      mean += path[f] / (contact.end - contact.first);
    }
    for (int f = contact.first; f < contact.end; ++f) {
      path[f] -= mean;
    }
  }
  return path;
}

// What both have in common: of all between them the one nearest to nothing.
Vec3 Common(const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double part = -a.dot(way) / std::max(way.squaredNorm(), 1e-12);
  return a + std::clamp(part, 0.0, 1.0) * way;
}

// How the body follows feet that glide with it.
Path FollowGlide(const std::array<FootTrack, 2>& feet, const std::array<Path, 2>& held,
                 double rate_hz, double cutoff_hz) {
  const int frames = feet[0].num_frames();
  Path body(frames, Vec3::Zero());
  for (const int axis : {0, 2}) {
    std::vector<std::optional<double>> known(frames);
    for (int f = 0; f < frames; ++f) {
      const bool right = feet[0].standing[f], left = feet[1].standing[f];
      if (right && left) {
        known[f] = Common(held[0][f], held[1][f])[axis];
      } else if (right || left) {
        known[f] = held[right ? 0 : 1][f][axis];
      }
    }
    const std::vector<double> filled = FillBetween(known);
    for (int f = 0; f < frames; ++f) body[f][axis] = filled[f];
  }
  Smooth(body, rate_hz, cutoff_hz);
  return body;
}

// (frames) How far the pelvis sinks, so that the legs reach their targets.
std::vector<double> PlanDrop(const motion::Clip& clip, const std::array<FootTrack, 2>& feet,
                             const std::array<std::vector<FootTarget>, 2>& targets,
                             const PreparationConfig& config) {
  const int frames = clip.num_frames();
  std::vector<double> needed(frames, 0.0), drop(frames, 0.0);
  for (int f = 0; f < frames; ++f) {
    for (int side = 0; side < 2; ++side) {
      if (!feet[side].standing[f]) continue;
      needed[f] = std::max(needed[f], DropToReach(clip, f, feet[side], targets[side][f].ankle));
    }
  }
  const int spread = static_cast<int>(std::lround(kDropSpread_s * clip.frame_rate()));
  for (int f = 0; f < frames; ++f) {
    for (int k = std::max(0, f - spread); k <= std::min(frames - 1, f + spread); ++k) {
      drop[f] = std::max(drop[f], std::min(needed[k], config.longest_drop_m));
    }
  }
  math::LowPassZeroPhase(drop, clip.frame_rate(), kDropCutoffHz);
  return drop;
}

// How far a foot swings close to the floor, 0 to 1: slow feet may turn on it.
double LowSwing(const FootTrack& foot, int frame) {
  const double fast = std::clamp((foot.speeds[frame] - kSwing) / (2 * kSwing), 0.0, 1.0);
  return fast * std::clamp(2 - foot.heights[frame] / kLowSwing, 0.0, 1.0);
}

// Where a foot is to be, from the displacement that holds it still, less what the body follows.
std::vector<FootTarget> PlanFoot(const std::vector<Contact>& contacts, const FootTrack& foot,
                                 const Path& body, const PreparationConfig& config, double rate_hz,
                                 Path path) {
  const int blend = std::max(1, static_cast<int>(std::lround(config.blend_s * rate_hz)));
  for (const Contact& contact : contacts) {
    for (int f = contact.first; f < contact.end; ++f) {
      path[f] -= body[f];
      path[f].y() = -foot.heights[f];
    }
  }
  BlendBetween(contacts, blend, path);
  for (int f = 0; f < foot.num_frames(); ++f) {
    if (!foot.standing[f]) path[f].y() += config.clearance_m * LowSwing(foot, f);
  }
  Smooth(path, rate_hz, kSmoothHz);
  // Smoothing and a swing that comes low leave it off the floor a little.
  std::vector<double> off(path.size());
  for (size_t f = 0; f < path.size(); ++f) {
    const double low = foot.heights[f] + path[f].y();
    off[f] = foot.standing[f] ? low : std::min(low, 0.0);
  }
  math::LowPassZeroPhase(off, rate_hz, kSmoothHz);
  std::vector<FootTarget> targets;
  for (size_t f = 0; f < path.size(); ++f) {
    path[f].y() -= off[f];
    path[f].y() -= std::min(foot.heights[f] + path[f].y(), 0.0);
    targets.push_back({foot.ankles[f] + body[f] + path[f], foot.rotations[f]});
  }
  return targets;
}

}  // namespace

motion::Clip PlantFeet(motion::Clip clip, const physics::HumanoidModel& model,
                       const PreparationConfig& config) {
  const double rate = clip.frame_rate();
  const std::vector<char> flight = FindFlight(clip, model);
  std::array<FootTrack, 2> feet = TrackFeet(clip, model);
  std::array<std::vector<Contact>, 2> contacts;
  std::array<Path, 2> held;
  for (int side = 0; side < 2; ++side) {
    FindContacts(flight, rate, config, feet[side]);
    contacts[side] = ListContacts(feet[side].standing);
    Flatten(contacts[side], rate, config, feet[side]);
    held[side] = HoldStill(contacts[side], feet[side]);
  }
  const Path body = FollowGlide(feet, held, rate, config.glide_cutoff_hz);
  std::array<std::vector<FootTarget>, 2> targets;
  for (int side = 0; side < 2; ++side) {
    targets[side] = PlanFoot(contacts[side], feet[side], body, config, rate, std::move(held[side]));
  }
  for (int f = 0; f < clip.num_frames(); ++f) clip.root_position(f) += body[f];
  const std::vector<double> drop = PlanDrop(clip, feet, targets, config);
  for (int f = 0; f < clip.num_frames(); ++f) {
    clip.root_position(f).y() -= drop[f];
    for (int side = 0; side < 2; ++side) BendLeg(targets[side][f], f, feet[side], clip);
  }
  return clip;
}

}  // namespace poise::correction
