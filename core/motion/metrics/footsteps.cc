#include "core/motion/metrics/footsteps.h"

#include <algorithm>

namespace poise::motion {
namespace {

Vec3 Horizontal(Vec3 vector, int up) {
  vector[up] = 0;
  return vector;
}

// Frames in which the joint moves fast, halts shorter than the rule's gap filled.
std::vector<Footstep> Movements(const std::vector<bool>& moving, int foot, int gap) {
  std::vector<Footstep> movements;
  for (int frame = 0; frame < static_cast<int>(moving.size()); ++frame) {
    if (!moving[frame]) continue;
    if (!movements.empty() && frame - movements.back().last <= gap) {
      movements.back().last = frame;
    } else {
      movements.push_back({foot, frame, frame});
    }
  }
  return movements;
}

}  // namespace

std::vector<Footstep> FindFootsteps(const PositionsView& motion, const FootJoints& feet,
                                    double frame_rate, const FootstepRule& rule) {
  std::vector<Footstep> steps;
  const int last = motion.frames() - 1;
  for (int foot = 0; foot < static_cast<int>(feet.joints.size()); ++foot) {
    const int joint = feet.joints[foot];
    const auto travel = [&](int from, int to) {
      return Horizontal(motion.position(to, joint) - motion.position(from, joint), feet.up).norm();
    };
    std::vector<bool> moving(motion.frames());
    for (int frame = 0; frame <= last; ++frame) {
      const int from = std::max(0, frame - rule.span / 2),
                to = std::min(last, from + rule.span - 1);
      if (to > from) moving[frame] = travel(from, to) * frame_rate / (to - from) >= rule.speed_mps;
    }
    for (const Footstep& movement : Movements(moving, foot, rule.gap)) {
      const bool long_enough = movement.last - movement.first + 1 >= rule.shortest;
      if (long_enough && travel(movement.first, movement.last) >= rule.length_m) {
        steps.push_back(movement);
      }
    }
  }
  return steps;
}

int CountRecalled(const std::vector<Footstep>& found, const std::vector<Footstep>& truth,
                  int tolerance) {
  return static_cast<int>(std::count_if(truth.begin(), truth.end(), [&](const Footstep& step) {
    return std::any_of(found.begin(), found.end(), [&](const Footstep& other) {
      return other.foot == step.foot && other.first <= step.last + tolerance &&
             other.last >= step.first - tolerance;
    });
  }));
}

}  // namespace poise::motion
