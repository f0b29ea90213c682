#include "core/motion/metrics/mpjpe.h"

namespace poise::motion {

double Mpjpe(const PositionsView& found, const PositionsView& truth) {
  double sum = 0;
  for (size_t i = 0; i < truth.positions.size(); ++i) {
    sum += (found.positions[i] - truth.positions[i]).norm();
  }
  return sum / truth.positions.size();
}

double RootAlignedMpjpe(const PositionsView& found, const PositionsView& truth, int root) {
  double sum = 0;
  for (int frame = 0; frame < truth.frames(); ++frame) {
    const Vec3 shift = truth.position(frame, root) - found.position(frame, root);
    for (int joint = 0; joint < truth.joints; ++joint) {
      sum += (found.position(frame, joint) + shift - truth.position(frame, joint)).norm();
    }
  }
  return sum / truth.positions.size();
}

}  // namespace poise::motion
