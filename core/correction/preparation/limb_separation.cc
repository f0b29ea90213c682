#include "core/correction/preparation/limb_separation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/math/low_pass.h"
#include "core/motion/metrics/self_penetration.h"

namespace poise::correction {
namespace {

using math::Quat;
using math::Vec3;
using enum motion::JointRole;

constexpr int kPasses = 6;
constexpr double kSmoothHz = 3;      // of the turns
constexpr double kShortLever = 0.1;  // [m] an overlap nearer to the hip or shoulder is left alone
constexpr double kSideways = 0.5;    // how much legs are kept on their own sides
constexpr std::array kBases = {kRightHip, kRightShoulder, kLeftHip, kLeftShoulder};

// Which of kBases carries the body, or -1 for the trunk.
int LimbOf(int body) {
  for (size_t limb = 0; limb < kBases.size(); ++limb) {
    const int base = static_cast<int>(kBases[limb]);
    if (body >= base && body < base + 3) return static_cast<int>(limb);
  }
  return -1;
}

struct Overlap {
  int limb_a, limb_b;  // -1: trunk
  Vec3 point;          // [m] between both
  Vec3 push;           // [m] that parts a from b
};

// The deepest overlap of each pair of limbs in one frame.
std::vector<Overlap> FindOverlaps(const motion::PlacedBodies& bodies, int frame,
                                  const std::vector<std::pair<int, int>>& pairs, double allowed,
                                  const Vec3& rightwards) {
  std::vector<Overlap> found;
  const motion::PlacedCapsule* capsules = bodies.frame(frame);
  for (const auto& [a, b] : pairs) {
    const int limb_a = LimbOf(a), limb_b = LimbOf(b);
    if (limb_a == limb_b) continue;
    const motion::SegmentGap gap = motion::NearestPoints(capsules[a], capsules[b]);
    Vec3 apart = gap.on_a - gap.on_b;
    const double depth = bodies.radii[a] + bodies.radii[b] - apart.norm();
    if (depth < allowed) continue;
    // Axes that (nearly) meet leave the direction open: a right leg goes to the right.
    if (limb_a == 0 && limb_b == 2) apart += kSideways * depth * rightwards;
    if (limb_a == 2 && limb_b == 0) apart -= kSideways * depth * rightwards;
    const Overlap overlap{limb_a, limb_b, (gap.on_a + gap.on_b) / 2, depth * apart.normalized()};
    const auto same = std::find_if(found.begin(), found.end(), [&](const Overlap& other) {
      return other.limb_a == limb_a && other.limb_b == limb_b;
    });
    if (same == found.end()) {
      found.push_back(overlap);
    } else if (same->push.norm() < depth) {
      *same = overlap;
    }
  }
  return found;
}

// Turn of a limb about its base, in world axes, that moves a point by `push`.
Vec3 TurnFor(const Vec3& base, const Vec3& point, const Vec3& push) {
  const Vec3 lever = point - base;
  return lever.cross(push) / std::max(lever.squaredNorm(), kShortLever * kShortLever);
}

using Turns = std::vector<std::array<Vec3, kBases.size()>>;  // (frames) in the parents' axes

bool AddTurns(const motion::Clip& clip, const physics::HumanoidModel& model,
              const std::vector<std::pair<int, int>>& pairs, double allowed, Turns& turns) {
  const motion::WorldPoses world = motion::ForwardKinematics(clip);
  motion::PlacedBodies bodies;
  motion::PlaceBodies(model.shapes(), world, bodies);
  const auto base = [&](int limb) { return static_cast<int>(kBases[limb]); };
  bool any = false;
  for (int f = 0; f < clip.num_frames(); ++f) {
    const Vec3 rightwards = (world.position(f, base(0)) - world.position(f, base(2))).normalized();
    for (const Overlap& overlap : FindOverlaps(bodies, f, pairs, allowed, rightwards)) {
      any = true;
      const double share = overlap.limb_a >= 0 && overlap.limb_b >= 0 ? 0.5 : 1;
      for (const auto& [limb, sign] :
           {std::pair(overlap.limb_a, share), std::pair(overlap.limb_b, -share)}) {
        if (limb < 0) continue;
        const int parent = clip.skeleton()->parent(base(limb));
        turns[f][limb] +=
            world.rotation(f, parent).conjugate() *
            TurnFor(world.position(f, base(limb)), overlap.point, sign * overlap.push);
      }
    }
  }
  return any;
}

void Smooth(double rate_hz, double widest, Turns& turns) {
  std::vector<double> channel(turns.size());
  for (size_t limb = 0; limb < kBases.size(); ++limb) {
    for (int axis = 0; axis < 3; ++axis) {
      for (size_t f = 0; f < turns.size(); ++f) channel[f] = turns[f][limb][axis];
      math::LowPassZeroPhase(channel, rate_hz, kSmoothHz);
      for (size_t f = 0; f < turns.size(); ++f) turns[f][limb][axis] = channel[f];
    }
    for (auto& frame : turns) {
      const double angle = frame[limb].norm();
      if (angle > widest) frame[limb] *= widest / angle;
    }
  }
}

}  // namespace

motion::Clip SeparateLimbs(motion::Clip clip, const physics::HumanoidModel& model,
                           const PreparationConfig& config) {
  const motion::Clip original = clip;
  const std::vector<std::pair<int, int>> pairs = motion::SeparatePairs(model.shapes());
  std::array<Vec3, kBases.size()> none;
  none.fill(Vec3::Zero());
  Turns turns(clip.num_frames(), none);
  for (int pass = 0; pass < kPasses; ++pass) {
    if (!AddTurns(clip, model, pairs, config.overlap_m, turns)) break;
    Turns smooth = turns;
    Smooth(clip.frame_rate(), config.widest_turn, smooth);
    for (int f = 0; f < clip.num_frames(); ++f) {
      for (size_t limb = 0; limb < kBases.size(); ++limb) {
        const int joint = static_cast<int>(kBases[limb]);
        clip.rotation(f, joint) =
            math::FromRotationVector(smooth[f][limb]) * original.rotation(f, joint);
      }
    }
  }
  return clip;
}

}  // namespace poise::correction
