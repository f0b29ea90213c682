#ifndef POISE_CORE_MOTION_METRICS_FOOTSTEPS_H_
#define POISE_CORE_MOTION_METRICS_FOOTSTEPS_H_

#include <vector>

#include "core/motion/metrics/foot_skate.h"

/// Which foot steps, and when.
namespace poise::motion {

/// A foot on its way: frames first .. last in which it moves.
struct Footstep {
  int foot = 0;  ///< index in FootJoints::joints
  int first = 0;
  int last = 0;
};

/// What counts as a step. A rule of ours: no source states one.
struct FootstepRule {
  double speed_mps = 0.4;  ///< [m/s, > 0] horizontal speed over `span` frames at which a foot moves
  int span = 5;            ///< [frames, > 1] over which the speed is measured
  int shortest = 5;        ///< [frames] a shorter movement is none
  int gap = 3;             ///< [frames] a shorter halt does not end a step
  double length_m = 0.06;  ///< [m] a foot that has come less far has not stepped
};

/// In the order of feet, then of frames.
std::vector<Footstep> FindFootsteps(const PositionsView& motion, const FootJoints& feet,
                                    double frame_rate, const FootstepRule& rule = {});

/// How many of the true steps were found: some found step of the same foot overlaps the true one's
/// frames, widened by `tolerance` to both sides.
int CountRecalled(const std::vector<Footstep>& found, const std::vector<Footstep>& truth,
                  int tolerance);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_METRICS_FOOTSTEPS_H_
