#include "core/push/evaluation/take_scores.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "core/motion/metrics/ade_fde.h"
#include "core/motion/metrics/bone_length.h"
#include "core/motion/metrics/foot_skate.h"
#include "core/motion/metrics/footsteps.h"
#include "core/motion/metrics/mpjpe.h"

namespace poise::push {
namespace {

using motion::PositionsView;

constexpr std::array kAnkles = {kRightAnkle, kLeftAnkle};
constexpr int kUp = 2;  // ground frame
constexpr motion::FootJoints kToeJoints{kToes, kUp};
constexpr motion::FootJoints kAnkleJoints{kAnkles, kUp};
constexpr double kToeContact = 0.05;  // [m]
constexpr int kStepTolerance = 8;     // [frames]

// Measures of one motion alone.
void AddFeet(const PositionsView& motion, const std::string& prefix, double share, Measures& out) {
  const auto skate = [&](const motion::FootJoints& feet, double height) {
    return share * motion::FootSkateError(motion, feet, height, kFrameRate);
  };
  out[prefix + "fse_toe_033"] += skate(kToeJoints, 0.033);
  out[prefix + "fse_toe_050"] += skate(kToeJoints, 0.05);
  out[prefix + "fse_ankle_150"] += skate(kAnkleJoints, 0.15);
  out[prefix + "toe_contact"] += share * motion::ContactShare(motion, kToeJoints, kToeContact);
}

void AddErrors(const PositionsView& found, const PositionsView& truth, double share,
               Measures& out) {
  const motion::DisplacementError hip = motion::PathError(found, truth, kPelvis);
  out["mpjpe"] += share * motion::Mpjpe(found, truth);
  out["hipade"] += share * hip.average;
  out["hipfde"] += share * hip.final;
  out["mble"] += share * motion::BoneLengthError(found, truth, kBodyParents);
  out["pose_only"] += share * motion::RootAlignedMpjpe(found, truth, kPelvis);
}

struct StepCounts {
  int found = 0, truth = 0, recalled = 0;
};

StepCounts CountSteps(const PositionsView& found, const PositionsView& truth) {
  const auto steps = motion::FindFootsteps(found, kToeJoints, kFrameRate);
  const auto true_steps = motion::FindFootsteps(truth, kToeJoints, kFrameRate);
  return {static_cast<int>(steps.size()), static_cast<int>(true_steps.size()),
          motion::CountRecalled(steps, true_steps, kStepTolerance)};
}

}  // namespace

TakeScores ScoreTake(const PushTake& take, const ForecastJoints& forecast, int first_frame) {
  TakeScores scores{take.name(), {}};
  Measures& out = scores.measures;
  StepCounts steps;
  const double share = 1.0 / take.people.size();
  for (size_t i = 0; i < take.people.size(); ++i) {
    const PositionsView whole{kBodyJoints, forecast[i]};
    const PositionsView true_whole{kBodyJoints, take.people[i].joints};
    AddErrors(whole.From(first_frame), true_whole.From(first_frame), share, out);
    AddFeet(whole.From(first_frame), "", share, out);
    AddFeet(true_whole.From(first_frame), "true_", share, out);
    const StepCounts counts = CountSteps(whole, true_whole);
    steps.found += counts.found;
    steps.truth += counts.truth;
    steps.recalled += counts.recalled;
  }
  out["steps"] = steps.found;
  out["true_steps"] = steps.truth;
  out["step_recall"] = steps.truth == 0 ? -1 : static_cast<double>(steps.recalled) / steps.truth;
  return scores;
}

Measures MeanOverTakes(std::span<const TakeScores> takes) {
  Measures mean;
  double recalled = 0;
  for (const TakeScores& take : takes) {
    for (const auto& [name, value] : take.measures) mean[name] += value / takes.size();
    const double steps = take.measures.at("true_steps");
    if (steps > 0) recalled += take.measures.at("step_recall") * steps;
  }
  const double steps = mean["true_steps"] * takes.size();
  mean["step_recall"] = steps == 0 ? -1 : recalled / steps;
  mean["step_ratio"] = steps == 0 ? -1 : mean["steps"] * takes.size() / steps;
  return mean;
}

std::vector<TakeScores> WithoutOutliers(std::span<const TakeScores> takes) {
  std::vector<TakeScores> kept;
  std::copy_if(takes.begin(), takes.end(), std::back_inserter(kept), [](const TakeScores& take) {
    return take.take != "X07[11]" && take.take != "row_1[6]";
  });
  return kept;
}

}  // namespace poise::push
