#ifndef POISE_CORE_PUSH_EVALUATION_TAKE_SCORES_H_
#define POISE_CORE_PUSH_EVALUATION_TAKE_SCORES_H_

#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/push/takes/push_take.h"

/// A forecast held against a recorded take (reference push.md sec. 10).
namespace poise::push {

/// A forecast of a take: per person (frames, kBodyJoints) [m], ground frame.
using ForecastJoints = std::vector<std::vector<Vec3>>;

/// Measures by name: mpjpe hipade hipfde mble fse_toe_033 fse_toe_050 fse_ankle_150 pose_only
/// toe_contact steps [m, m/s, share, count]; those of feet also with the prefix "true_" for the
/// recording itself; step_recall (-1 when nobody really stepped).
using Measures = std::map<std::string, double>;

struct TakeScores {
  std::string take;  ///< "X07[11]"
  Measures measures;
};

/// Means over people and over frames `first_frame`..; the usual first frame is 1, since frame 0 is
/// given; 0 reproduces the anchors of the reference. Preconditions: the forecast has the take's
/// people and frames.
TakeScores ScoreTake(const PushTake& take, const ForecastJoints& forecast, int first_frame = 1);

/// Mean over takes of each measure; step_recall and the ratio steps / true_steps over all steps
/// together ("step_ratio").
Measures MeanOverTakes(std::span<const TakeScores> takes);

/// Without the two outliers that are reported apart: X07[11] and row_1[6].
std::vector<TakeScores> WithoutOutliers(std::span<const TakeScores> takes);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_EVALUATION_TAKE_SCORES_H_
