#include "core/motion/metrics/bone_length.h"

#include <cmath>

namespace poise::motion {

double BoneLengthError(const PositionsView& found, const PositionsView& truth,
                       std::span<const int> parents) {
  const auto length = [&](const PositionsView& motion, int frame, int joint) {
    return (motion.position(frame, joint) - motion.position(frame, parents[joint])).norm();
  };
  double sum = 0;
  int bones = 0;
  for (int frame = 0; frame < truth.frames(); ++frame) {
    for (int joint = 0; joint < truth.joints; ++joint) {
      if (parents[joint] < 0) continue;
      sum += std::abs(length(found, frame, joint) - length(truth, frame, joint));
      ++bones;
    }
  }
  return sum / bones;
}

}  // namespace poise::motion
