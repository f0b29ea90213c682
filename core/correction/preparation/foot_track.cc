#include "core/correction/preparation/foot_track.h"

#include <algorithm>
#include <cmath>

#include "core/math/low_pass.h"
#include "core/motion/kinematics/forward_kinematics.h"

namespace poise::correction {
namespace {

using enum motion::JointRole;

constexpr double kFreeFall = -4.9;     // [m/s2] half of a free fall
constexpr double kFlightCutoffHz = 8;  // of the centre of mass
constexpr double kRise = 0.4;          // [m/s] a foot that rises or sinks faster does not stand
constexpr double kLeave = 1.2;         // of the limits of height and speed, to end a contact

FootTrack MakeTrack(const motion::BodyShape& box, motion::JointRole ankle) {
  FootTrack track;
  track.ankle = static_cast<int>(ankle);
  track.knee = track.ankle - 1;
  track.hip = track.ankle - 2;
  track.up = box.orientation * Vec3::UnitY();
  track.forward = box.orientation * Vec3::UnitX();
  for (int corner = 0; corner < 4; ++corner) {
    const Vec3 signs(corner & 1 ? 1 : -1, -1, corner & 2 ? 1 : -1);
    track.sole[corner] = box.center + box.orientation * signs.cwiseProduct(box.half_extents);
  }
  return track;
}

int LowestCorner(const FootTrack& track, int frame) {
  int lowest = 0;
  for (int corner = 1; corner < 4; ++corner) {
    if (track.Corner(frame, corner).y() < track.Corner(frame, lowest).y()) lowest = corner;
  }
  return lowest;
}

void Follow(const motion::WorldPoses& world, double frame_rate, FootTrack& track) {
  const int frames = world.num_frames;
  for (int f = 0; f < frames; ++f) {
    track.ankles.push_back(world.position(f, track.ankle));
    track.rotations.push_back(world.rotation(f, track.ankle));
  }
  for (int f = 0; f < frames; ++f) {
    const int corner = LowestCorner(track, f);
    const int a = std::max(f - 1, 0), b = std::min(f + 1, frames - 1);
    const Vec3 velocity =
        (track.Corner(b, corner) - track.Corner(a, corner)) * (frame_rate / (b - a));
    track.heights.push_back(track.Corner(f, corner).y());
    track.speeds.push_back(std::hypot(velocity.x(), velocity.z()));
    track.rises.push_back(velocity.y());
  }
  track.standing.assign(frames, 0);
}

// Runs of `value` shorter than `shortest` frames between two others become the other value.
void DropShortRuns(char value, int shortest, std::vector<char>& marks) {
  const int frames = static_cast<int>(marks.size());
  for (int first = 0; first < frames;) {
    int end = first;
    while (end < frames && marks[end] == marks[first]) ++end;
    if (marks[first] == value && end - first < shortest && (value || (first > 0 && end < frames))) {
      std::fill(marks.begin() + first, marks.begin() + end, static_cast<char>(!value));
    }
    first = end;
  }
}

}  // namespace

std::array<FootTrack, 2> TrackFeet(const motion::Clip& clip, const physics::HumanoidModel& model) {
  const motion::WorldPoses world = motion::ForwardKinematics(clip);
  std::array<FootTrack, 2> feet;
  for (const auto& [at, ankle] : {std::pair(0, kRightAnkle), std::pair(1, kLeftAnkle)}) {
    feet[at] = MakeTrack(model.shapes()[static_cast<int>(ankle)], ankle);
    Follow(world, clip.frame_rate(), feet[at]);
  }
  return feet;
}

std::vector<char> FindFlight(const motion::Clip& clip, const physics::HumanoidModel& model) {
  const motion::WorldPoses world = motion::ForwardKinematics(clip);
  const physics::Articulation& tree = model.articulation();
  std::vector<double> heights(clip.num_frames(), 0.0);
  for (int f = 0; f < clip.num_frames(); ++f) {
    for (int i = 0; i < tree.num_bodies; ++i) {
      const Vec3 local = Eigen::Map<const Vec3>(tree.bodies[i].center_of_mass);
      heights[f] += tree.bodies[i].mass / model.total_mass() * world.Point(f, i, local).y();
    }
  }
  math::LowPassZeroPhase(heights, clip.frame_rate(), kFlightCutoffHz);
  std::vector<char> flight(clip.num_frames(), 0);
  const double rate2 = clip.frame_rate() * clip.frame_rate();
  for (int f = 1; f + 1 < clip.num_frames(); ++f) {
    flight[f] = (heights[f - 1] - 2 * heights[f] + heights[f + 1]) * rate2 < kFreeFall;
  }
  return flight;
}

void FindContacts(const std::vector<char>& flight, double frame_rate,
                  const PreparationConfig& config, FootTrack& foot) {
  bool standing = false;
  for (int f = 0; f < foot.num_frames(); ++f) {
    const double high = foot.heights[f] / config.contact_height_m;
    const double fast =
        std::max(foot.speeds[f] / config.contact_speed_mps, std::abs(foot.rises[f]) / kRise);
    standing = !flight[f] && (standing ? high < kLeave && fast < kLeave : high < 1 && fast < 1);
    foot.standing[f] = standing;
  }
  const int shortest = static_cast<int>(std::lround(config.shortest_s * frame_rate));
  DropShortRuns(0, shortest, foot.standing);
  DropShortRuns(1, shortest, foot.standing);
}

}  // namespace poise::correction
