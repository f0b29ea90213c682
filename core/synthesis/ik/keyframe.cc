#include "core/synthesis/ik/keyframe.h"

#include <algorithm>
#include <cmath>

namespace poise::synthesis {
namespace {

using motion::Vec3;

constexpr double kReferenceGridRate = 30;  // [Hz]
constexpr int kFramesAtOnce = 256;

struct Excursion {
  int frame = 0;  // of the largest distance
  double largest = -1;
};

std::vector<int> CandidateFrames(int num_frames, double frame_rate, bool on_grid) {
  std::vector<int> frames;
  if (on_grid) {
    const int points =
        static_cast<int>(std::floor((num_frames - 1) / frame_rate * kReferenceGridRate));
    for (int i = 0; i < points; ++i) {
      frames.push_back(static_cast<int>(std::lround(i / kReferenceGridRate * frame_rate)));
    }
  }
  if (frames.empty()) {  // the paper's rule, or a clip shorter than one step of the grid
    for (int i = 0; i < num_frames; ++i) frames.push_back(i);
  }
  return frames;
}

Excursion FindExcursion(const std::vector<Vec3>& a, const std::vector<Vec3>& b,
                        const std::vector<int>& frames, bool horizontal) {
  Excursion excursion;
  for (const int frame : frames) {
    Vec3 between = a[frame] - b[frame];
    if (horizontal) between.y() = 0;
    const double distance = between.norm();
    if (distance > excursion.largest) {
      excursion.largest = distance;
      excursion.frame = frame;
    }
  }
  return excursion;
}

// The side that is farther along the pelvis's horizontal velocity.
Side LeadingSide(const EndEffectorTracks& tracks, int frame) {
  const int last = static_cast<int>(tracks.pelvis.size()) - 1;
  Vec3 velocity = tracks.pelvis[std::min(frame + 1, last)] - tracks.pelvis[std::max(frame - 1, 0)];
  velocity.y() = 0;
  const double right = velocity.dot(tracks.right[frame]), left = velocity.dot(tracks.left[frame]);
  return left > right ? Side::kLeft : Side::kRight;
}

}  // namespace

EndEffectorTracks TrackEndEffectors(const motion::Clip& clip, int pelvis,
                                    const std::optional<Limb>& right,
                                    const std::optional<Limb>& left) {
  EndEffectorTracks tracks{.frame_rate = clip.frame_rate(), .pelvis = {}, .right = {}, .left = {}};
  motion::WorldPoses poses;
  for (int first = 0; first < clip.num_frames(); first += kFramesAtOnce) {
    const int count = std::min(kFramesAtOnce, clip.num_frames() - first);
    motion::ForwardKinematics(clip, first, count, poses);
    for (int frame = 0; frame < count; ++frame) {
      tracks.pelvis.push_back(poses.position(frame, pelvis));
      if (right) tracks.right.push_back(poses.position(frame, right->end));
      if (left) tracks.left.push_back(poses.position(frame, left->end));
    }
  }
  return tracks;
}

Keyframe SelectKeyframe(const EndEffectorTracks& tracks, bool two_sided, const IkConfig& config) {
  const bool paper = config.keyframe_rule == "paper";
  const std::vector<int> frames =
      CandidateFrames(static_cast<int>(tracks.pelvis.size()), tracks.frame_rate, !paper);
  const bool by_hand = config.keyframe >= 0;
  Keyframe keyframe;
  if (two_sided && !paper && !tracks.right.empty() && !tracks.left.empty()) {
    keyframe.frame =
        by_hand ? config.keyframe : FindExcursion(tracks.right, tracks.left, frames, true).frame;
    keyframe.side = LeadingSide(tracks, keyframe.frame);
    return keyframe;
  }
  Excursion right, left;
  if (!tracks.right.empty()) right = FindExcursion(tracks.right, tracks.pelvis, frames, !paper);
  if (!tracks.left.empty()) left = FindExcursion(tracks.left, tracks.pelvis, frames, !paper);
  const bool left_wins = left.largest > right.largest;  // -1 where a side is no candidate
  keyframe.side = left_wins ? Side::kLeft : Side::kRight;
  keyframe.frame = by_hand ? config.keyframe : (left_wins ? left : right).frame;
  return keyframe;
}

}  // namespace poise::synthesis
