#include "core/push/restoration/step_planner.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace poise::push {
namespace {

// From 0 to 1 without a jump in speed or acceleration (minimum jerk).
double Eased(double time) { return time * time * time * (10 + time * (6 * time - 15)); }

}  // namespace

std::vector<base::Field> StepConfig::Fields() {
  return {base::Flag("enabled", &enabled),
          base::Number("probability", &probability, 0, 1),
          base::Number("shortest_m", &shortest_m, 0, 1),
          base::Number("farthest_m", &farthest_m, 0.05, 2),
          base::Number("frames", &frames, 4, 60),
          base::Number("frames_per_m", &frames_per_m, 0, 60),
          base::Number("lift_m", &lift_m, 0, 0.3),
          base::Number("lift_share", &lift_share, 0, 1),
          base::Number("aimed_share", &aimed_share, 0, 1),
          base::Number("rest_frames", &rest_frames, 0, 60)};
}

StepPlanner::StepPlanner(const std::array<Vec3, 2>& toes)
    : toes_(toes), floor_{toes[0].z(), toes[1].z()} {}

void StepPlanner::Advance(const StepConfig& config, int foot, const Eigen::Vector2d& foothold) {
  Swing& swing = *swings_[foot];
  if (swing.progress < config.aimed_share) swing.goal = foothold;
  const double before = Eased(swing.progress);
  swing.progress = std::min(1.0, swing.progress + 1 / swing.frames);
  // The same share of what remains as if the goal had always been this one.
  const double share = (Eased(swing.progress) - before) / (1 - before);
  toes_[foot].head<2>() += share * (swing.goal - toes_[foot].head<2>());
  toes_[foot].z() = floor_[foot] + swing.lift * std::sin(std::numbers::pi * swing.progress);
  if (swing.progress < 1) return;
  toes_[foot].z() = floor_[foot];
  swings_[foot].reset();
  stood_[foot] = 0;
}

// The foot that needs it more leaves, when one does.
void StepPlanner::BeginOne(const StepConfig& config, const std::array<FootWish, 2>& wishes) {
  constexpr double kFarWeight = 0.5;  // [1/m] of the way beside the probability
  constexpr double kMostFrames = 26;  // a swing of the longest recorded steps
  int chosen = -1;
  double most = 0;
  for (int foot = 0; foot < 2; ++foot) {
    if (stood_[foot] < config.rest_frames) continue;
    const double way = (wishes[foot].foothold - toes_[foot].head<2>()).norm();
    const bool wanted = wishes[foot].swings > config.probability && way > config.shortest_m;
    const double need = wishes[foot].swings + kFarWeight * way;
    if ((wanted || way > config.farthest_m) && need > most) {
      chosen = foot;
      most = need;
    }
  }
  if (chosen < 0) return;
  const double way = (wishes[chosen].foothold - toes_[chosen].head<2>()).norm();
  swings_[chosen] =
      Swing{.frames = std::min(kMostFrames, config.frames + config.frames_per_m * way),
            .lift = config.lift_m + config.lift_share * way,
            .goal = wishes[chosen].foothold};
}

void StepPlanner::Step(const StepConfig& config, const std::array<FootWish, 2>& wishes,
                       bool may_begin) {
  for (int foot = 0; foot < 2; ++foot) {
    if (swings_[foot]) {
      Advance(config, foot, wishes[foot].foothold);
    } else {
      stood_[foot] = std::min(stood_[foot] + 1, kLong);
    }
  }
  if (may_begin && !swinging()) BeginOne(config, wishes);
}

}  // namespace poise::push
