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
          base::Number("balance_m", &balance_m, 0.02, 5),
          base::Number("balance_frames", &balance_frames, 0, 600),
          base::Number("frames", &frames, 4, 60),
          base::Number("frames_per_m", &frames_per_m, 0, 60),
          base::Number("lift_m", &lift_m, 0, 0.3),
          base::Number("lift_share", &lift_share, 0, 1),
          base::Number("aimed_share", &aimed_share, 0, 1),
          base::Number("rest_frames", &rest_frames, 0, 60)};
}

StepPlanner::StepPlanner(const std::array<Vec3, 2>& toes)
    : toes_(toes), floor_{toes[0].z(), toes[1].z()} {}

void StepPlanner::Advance(const StepConfig& config, int foot, const FootWish& wish) {
  Swing& swing = *swings_[foot];
  if (swing.progress < config.aimed_share) {
    swing.goal = swing.to_balance ? wish.balance : wish.foothold;
  }
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

void StepPlanner::Begin(const StepConfig& config, int foot, bool to_balance, const FootWish& wish) {
  constexpr double kMostFrames = 26;  // a swing of the longest recorded steps
  const Eigen::Vector2d& goal = to_balance ? wish.balance : wish.foothold;
  const double way = (goal - toes_[foot].head<2>()).norm();
  leaning_ = 0;
  swings_[foot] = Swing{.frames = std::min(kMostFrames, config.frames + config.frames_per_m * way),
                        .lift = config.lift_m + config.lift_share * way,
                        .to_balance = to_balance,
                        .goal = goal};
}

// The foot that needs it more leaves, when one does.
void StepPlanner::BeginOne(const StepConfig& config, const std::array<FootWish, 2>& wishes) {
  constexpr double kFarWeight = 0.5;  // [1/m] of the way beside the probability
  int wanted = -1, farther = -1;
  double most = 0, farthest = 0, nearest = config.balance_m;
  for (int foot = 0; foot < 2; ++foot) {
    const FootWish& wish = wishes[foot];
    const Eigen::Vector2d toe = toes_[foot].head<2>();
    const double out = (wish.balance - toe).norm();
    nearest = std::min(nearest, out);
    if (stood_[foot] < config.rest_frames) continue;
    if (out > farthest) {
      farther = foot;
      farthest = out;
    }
    const double way = (wish.foothold - toe).norm();
    const bool likely = wish.swings > config.probability && way > config.shortest_m;
    const double need = wish.swings + kFarWeight * way;
    if ((likely || way > config.farthest_m) && need > most) {
      wanted = foot;
      most = need;
    }
  }
  leaning_ = nearest == config.balance_m ? leaning_ + 1 : 0;
  if (wanted >= 0) {
    Begin(config, wanted, false, wishes[wanted]);
  } else if (farther >= 0 && leaning_ > config.balance_frames) {
    Begin(config, farther, true, wishes[farther]);
  }
}

void StepPlanner::Step(const StepConfig& config, const std::array<FootWish, 2>& wishes,
                       bool may_begin) {
  for (int foot = 0; foot < 2; ++foot) {
    if (swings_[foot]) {
      Advance(config, foot, wishes[foot]);
    } else {
      stood_[foot] = std::min(stood_[foot] + 1, kLong);
    }
  }
  if (may_begin && !swinging()) BeginOne(config, wishes);
}

}  // namespace poise::push
