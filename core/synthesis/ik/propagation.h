#ifndef POISE_CORE_SYNTHESIS_IK_PROPAGATION_H_
#define POISE_CORE_SYNTHESIS_IK_PROPAGATION_H_

#include <vector>

#include "core/synthesis/ik/ik_config.h"

namespace poise::synthesis {

/// How much of the keyframe's displacement each frame gets: 1 at the keyframe, 0 at both ends of
/// the clip (ramp) or from window_s away from the keyframe on (window). Frames outside
/// [first, first + weights.size()) get 0.
struct Propagation {
  int first = 0;
  std::vector<double> weights;
};

/// Source: MotionAug sec. 3.2 (ramp), the authors' program (window), reference sec. 3.4; the
/// minimum-jerk profile 10 u^3 - 15 u^4 + 6 u^5 in place of the line u is ours.
Propagation Propagate(int num_frames, double frame_rate, int keyframe, const IkConfig& config);

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_IK_PROPAGATION_H_
