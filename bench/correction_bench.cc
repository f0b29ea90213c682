#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/benchmark.h"
#include "core/correction/corrector.h"
#include "core/motion/io/clip_file.h"
#include "tests/support/broken_clips.h"

/// What the efforts `instant` and `fast` reach on real clips (HDM05 below POISE_DATA_DIR), beside
/// the zero policy of the paper. The controller's constants were chosen on actors bd and bk; dg, mm
/// and tr are held out. And what is left of faults in clips that were broken on purpose. Nothing is
/// measured where the data is missing.
namespace poise::bench {
namespace {

using correction::Correction;
using correction::CorrectionConfig;
using correction::Corrector;

const char* const kClasses[] = {"kickLFront1Reps", "jogLeftCircle4StepsRstart", "grabHighR",
                                "depositFloorR",   "sneak2StepsLStart",         "throwBasketball",
                                "hopBothLegs1hops"};

struct Actors {
  const char* name;
  std::vector<std::string> codes;
};
const Actors kActors[] = {{"bd_bk", {"bd", "bk"}}, {"held_out", {"dg", "mm", "tr"}}};

struct Sum {
  int clips = 0, completed = 0;
  // Means over clips, until Finish sums; a clip that diverged counts as 0 reward.
  double reward = 0, force = 0, force_peak = 0, torque = 0;
  double skate_before = 0, skate_after = 0, penetration_after = 0;
  double seconds = 0;

  void Add(const Correction& correction) {
    completed += correction.score.completed;
    reward += correction.score.reward_normalised;
    force += correction.score.residual_force_mean_bw;
    force_peak += correction.score.residual_force_peak_bw;
    torque += correction.score.residual_torque_mean_nm;
    skate_before += correction.before.foot_skate_mps;
    skate_after += correction.after.foot_skate_mps;
    penetration_after += correction.after.penetration_mean_m;
  }
  void Finish() {
    for (double* mean : {&reward, &force, &force_peak, &torque, &skate_before, &skate_after,
                         &penetration_after, &seconds}) {
      *mean /= std::max(clips, 1);
    }
  }
};

// HDM_bd_kick...: the two letters after the first underscore.
bool IsOf(const Actors& actors, const std::filesystem::path& file) {
  const std::string code = file.filename().string().substr(4, 2);
  return std::find(actors.codes.begin(), actors.codes.end(), code) != actors.codes.end();
}

Sum CorrectAll(const std::filesystem::path& folder, const Actors& actors,
               const CorrectionConfig& config) {
  Sum sum;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".amc" || !IsOf(actors, entry.path())) continue;
    const auto file = motion::ReadClipFile(entry.path());
    if (!file.ok()) continue;
    const motion::JointRoles roles = *motion::JointRoles::Detect(*file->clip.skeleton());
    const double start = ThreadSeconds();
    const auto corrector = Corrector::Create(file->clip, roles, config);
    const auto correction = corrector->Correct(file->clip);
    sum.seconds += ThreadSeconds() - start;
    ++sum.clips;
    if (correction.ok()) sum.Add(*correction);
  }
  sum.Finish();
  return sum;
}

void AddRows(const std::string& name, const std::string& peer, double seconds_allowed,
             const Sum& ours, const Sum& theirs, std::vector<Row>& rows) {
  const auto add = [&](const std::string& what, double value, const std::string& unit,
                       const std::string& against, double ratio) {
    rows.push_back({name + "/" + what, value, unit, against, ratio, 1});
  };
  add("completed", 100.0 * ours.completed / ours.clips, "% of " + std::to_string(ours.clips), peer,
      static_cast<double>(ours.completed) / std::max(theirs.completed, 1));
  add("reward_normalised", 1000 * ours.reward, "/ 1000", peer, ours.reward / theirs.reward);
  add("residual_force_mean", 1000 * ours.force, "bw / 1000", peer, theirs.force / ours.force);
  add("residual_force_peak", 1000 * ours.force_peak, "bw / 1000", peer,
      theirs.force_peak / ours.force_peak);
  add("residual_torque_mean", ours.torque, "N m", peer, theirs.torque / ours.torque);
  add("skating", 1000 * ours.skate_after, "mm/s", "the clip itself",
      ours.skate_before / ours.skate_after);
  add("penetration_mean", 1000 * ours.penetration_after, "mm", "0.5 mm allowed",
      0.0005 / ours.penetration_after);
  add("time", 1000 * ours.seconds, "ms/clip", fmt::format("{} s allowed", seconds_allowed),
      seconds_allowed / ours.seconds);
}

// What the correction of broken clips leaves of a measure.
void AddBroken(const std::filesystem::path& hdm05, std::vector<Row>& rows) {
  constexpr const char* kFiles[] = {
      "kickLFront1Reps/HDM_bd_kickLFront1Reps_001_120.amc",
      "jogLeftCircle4StepsRstart/HDM_bd_jogLeftCircle4StepsRstart_001_120.amc",
      "sneak2StepsLStart/HDM_mm_sneak2StepsLStart_011_120.amc",
      "grabHighR/HDM_dg_grabHighR_011_120.amc",
      "kickLFront1Reps/HDM_tr_kickLFront1Reps_025_120.amc",
  };
  CorrectionConfig config;
  config.effort = "instant";
  for (const testing::Fault fault : testing::kFaults) {
    motion::Plausibility before, after;
    for (const char* name : kFiles) {
      const auto file = motion::ReadClipFile(hdm05 / name);
      if (!file.ok()) return;
      const motion::JointRoles roles = *motion::JointRoles::Detect(*file->clip.skeleton());
      const motion::Clip broken = testing::Break(file->clip, roles, fault);
      const auto correction = Corrector::Create(broken, roles, config)->Correct(broken);
      if (!correction.ok()) continue;
      for (const auto& [sum, one] :
           {std::pair(&before, &correction->before), std::pair(&after, &correction->after)}) {
        sum->foot_skate_mps += one->foot_skate_mps / 5;
        sum->penetration_mean_m += one->penetration_mean_m / 5;
        sum->float_mean_m += one->float_mean_m / 5;
        sum->self_penetration_max_m += one->self_penetration_max_m / 5;
      }
    }
    const auto add = [&](const char* what, const char* unit, double motion::Plausibility::*value) {
      rows.push_back({fmt::format("correction/broken/{}/{}", testing::FaultName(fault), what),
                      1000 * after.*value, unit, "before", before.*value / (after.*value), 1});
    };
    add("skating", "mm/s", &motion::Plausibility::foot_skate_mps);
    add("penetration_mean", "mm", &motion::Plausibility::penetration_mean_m);
    add("float_mean", "mm", &motion::Plausibility::float_mean_m);
    add("self_penetration_max", "mm", &motion::Plausibility::self_penetration_max_m);
  }
}

}  // namespace

std::vector<Row> RunCorrectionBenchmark() {
  std::vector<Row> rows;
  const char* data = std::getenv("POISE_DATA_DIR");
  if (data == nullptr) return rows;
  AddBroken(std::filesystem::path(data) / "hdm05", rows);
  const CorrectionConfig paper = *CorrectionConfig::FromPreset("paper");
  const CorrectionConfig fast;
  CorrectionConfig instant;
  instant.effort = "instant";
  for (const char* name : kClasses) {
    const std::filesystem::path folder = std::filesystem::path(data) / "hdm05" / name;
    if (!std::filesystem::exists(folder)) continue;
    for (const Actors& actors : kActors) {
      const std::string group = fmt::format("{}/{}", name, actors.name);
      const Sum at_once = CorrectAll(folder, actors, instant);
      AddRows("correction/instant/" + group, "zero policy of the paper", 1, at_once,
              CorrectAll(folder, actors, paper), rows);
      AddRows("correction/fast/" + group, "instant", 3, CorrectAll(folder, actors, fast), at_once,
              rows);
    }
  }
  return rows;
}

}  // namespace poise::bench
