#include "core/motion/metrics/foot_skate.h"

#include <algorithm>
#include <cmath>

namespace poise::motion {

double FootSkateError(const PositionsView& motion, const FootJoints& feet, double height_m,
                      double frame_rate) {
  double sum = 0;
  int samples = 0;
  for (int frame = 1; frame < motion.frames(); ++frame) {
    for (const int joint : feet.joints) {
      const double height = motion.position(frame, joint)[feet.up];
      if (height > height_m) continue;
      Vec3 step = motion.position(frame, joint) - motion.position(frame - 1, joint);
      step[feet.up] = 0;
      sum += step.norm() * frame_rate * (2 - std::exp2(height / height_m));
      ++samples;
    }
  }
  return samples == 0 ? 0 : sum / samples;
}

double ContactShare(const PositionsView& motion, const FootJoints& feet, double height_m) {
  int low = 0;
  for (int frame = 0; frame < motion.frames(); ++frame) {
    low += std::any_of(feet.joints.begin(), feet.joints.end(), [&](int joint) {
      return motion.position(frame, joint)[feet.up] <= height_m;
    });
  }
  return static_cast<double>(low) / motion.frames();
}

}  // namespace poise::motion
