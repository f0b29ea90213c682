#include "core/motion/metrics/ade_fde.h"

namespace poise::motion {

DisplacementError PathError(const PositionsView& found, const PositionsView& truth, int joint) {
  DisplacementError error;
  for (int frame = 0; frame < truth.frames(); ++frame) {
    error.final = (found.position(frame, joint) - truth.position(frame, joint)).norm();
    error.average += error.final / truth.frames();
  }
  return error;
}

}  // namespace poise::motion
