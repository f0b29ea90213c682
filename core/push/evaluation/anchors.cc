#include "core/push/evaluation/anchors.h"

#include <fmt/format.h>

#include "core/push/takes/csv_table.h"

namespace poise::push {
namespace {

HipPath TrueHip(const TakePerson& person) {
  HipPath hip;
  for (int frame = 0; frame < person.frames(); ++frame) {
    hip.push_back(person.joint(frame, kPelvis));
  }
  return hip;
}

using HipsByTake = std::map<std::string, std::vector<HipPath>>;

HipsByTake StandingHips(const std::vector<PushTake>& takes, bool multi) {
  HipsByTake hips;
  for (const PushTake& take : takes) {
    if (take.split != Split::kTest || take.multi != multi) continue;
    for (const TakePerson& person : take.people) {
      hips[take.name()].emplace_back(take.frames, person.joint(0, kPelvis));
    }
  }
  return hips;
}

StatusOr<HipPath*> PathOf(HipsByTake& hips, const std::string& take, int person, int frame) {
  const auto found = hips.find(take);
  if (found == hips.end() || person < 0 || person >= static_cast<int>(found->second.size()) ||
      frame < 0 || frame >= static_cast<int>(found->second[person].size())) {
    return base::InvalidArgument(
        "MALFORMED_TAKE", "",
        fmt::format("prediction for {} person {} frame {}, which is not there", take, person,
                    frame));
  }
  return &found->second[person];
}

Status ReadSingle(const std::filesystem::path& folder, HipsByTake& hips) {
  POISE_ASSIGN_OR_RETURN(const CsvTable csv,
                         CsvTable::Read(folder / "upstream_predictions/single_test_ipm.csv",
                                        {"subject", "index", "frame", "hip_x", "hip_y", "hip_z"}));
  for (int row = 0; row < csv.num_rows(); ++row) {
    const std::string take = fmt::format("{}[{}]", csv.text(row, 0), csv.text(row, 1));
    const int frame = csv.integer(row, 2);
    POISE_ASSIGN_OR_RETURN(HipPath * path, PathOf(hips, take, 0, frame));
    (*path)[frame] = {csv.number(row, 3), csv.number(row, 4), csv.number(row, 5)};
  }
  return absl::OkStatus();
}

Status ReadMulti(const std::filesystem::path& folder, HipsByTake& hips) {
  POISE_ASSIGN_OR_RETURN(
      const CsvTable csv,
      CsvTable::Read(folder / "upstream_predictions/multi_test_ipm15.csv",
                     {"group", "take", "person", "frame", "hip_x", "hip_y", "hip_z"}));
  for (int row = 0; row < csv.num_rows(); ++row) {
    const std::string take = fmt::format("{}[{}]", csv.text(row, 0), csv.text(row, 1));
    const int frame = csv.integer(row, 3);
    POISE_ASSIGN_OR_RETURN(HipPath * path, PathOf(hips, take, csv.integer(row, 2), frame));
    HipPath& hip = *path;
    hip[frame] = {hip[0].x() + csv.number(row, 4), hip[0].y() + csv.number(row, 5),
                  csv.number(row, 6)};
    if (frame + 2 == static_cast<int>(hip.size())) hip.back() = hip[frame];
  }
  return absl::OkStatus();
}

}  // namespace

ForecastJoints Statue(const PushTake& take, const std::vector<HipPath>& hips) {
  ForecastJoints forecast;
  for (size_t i = 0; i < take.people.size(); ++i) {
    const std::span<const Vec3> pose = take.people[i].pose(0);
    std::vector<Vec3>& joints = forecast.emplace_back();
    for (const Vec3& hip : hips[i]) {
      for (const Vec3& joint : pose) joints.push_back(joint - pose[kPelvis] + hip);
    }
  }
  return forecast;
}

ForecastJoints NobodyMoves(const PushTake& take) {
  std::vector<HipPath> hips;
  for (const TakePerson& person : take.people) {
    hips.emplace_back(take.frames, person.joint(0, kPelvis));
  }
  return Statue(take, hips);
}

ForecastJoints StatueOnTrueHip(const PushTake& take) {
  std::vector<HipPath> hips;
  for (const TakePerson& person : take.people) hips.push_back(TrueHip(person));
  return Statue(take, hips);
}

StatusOr<HipsByTake> ReadReleasedHips(const std::filesystem::path& folder,
                                      const std::vector<PushTake>& takes) {
  HipsByTake hips = StandingHips(takes, false);
  if (!hips.empty()) POISE_RETURN_IF_ERROR(ReadSingle(folder, hips));
  HipsByTake several = StandingHips(takes, true);
  if (!several.empty()) POISE_RETURN_IF_ERROR(ReadMulti(folder, several));
  hips.merge(several);
  return hips;
}

}  // namespace poise::push
