#include "core/push/takes/fzj_takes.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "core/motion/io/clip_file.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "core/push/takes/csv_table.h"

namespace poise::push {
namespace {

namespace fs = std::filesystem;

// Takes by group and index.
using TakeTable = std::map<std::pair<std::string, int>, PushTake*>;

Status Malformed(const std::string& what, const std::string& problem) {
  return base::InvalidArgument("MALFORMED_TAKE", "", fmt::format("{}: {}", what, problem));
}

Status CheckBody(const TakePerson& person) {
  const motion::Skeleton& skeleton = *person.clip->skeleton();
  if (skeleton.num_joints() != kBodyJoints) {
    return Malformed(person.file, fmt::format("the skeleton has {} joints, expected {}",
                                              skeleton.num_joints(), kBodyJoints));
  }
  for (int joint = 0; joint < kBodyJoints; ++joint) {
    if (skeleton.joint(joint).name != fmt::format("joint_{}", joint) ||
        skeleton.parent(joint) != kBodyParents[joint]) {
      return Malformed(person.file,
                       fmt::format("joint {} is '{}' below {}, expected joint_{} "
                                   "below {}",
                                   joint, skeleton.joint(joint).name, skeleton.parent(joint), joint,
                                   kBodyParents[joint]));
    }
  }
  return absl::OkStatus();
}

StatusOr<TakePerson> ReadPerson(const fs::path& folder, const std::string& file, int frames) {
  const motion::ClipHints hints{
      .unit_m = 0.001, .up = motion::UpAxis::kZ, .frame_rate = kFrameRate};
  POISE_ASSIGN_OR_RETURN(motion::ClipFile read, motion::ReadClipFile(folder / file, hints));
  TakePerson person{
      .file = file, .suit = "", .clip = std::move(read.clip), .joints = {}, .rotations = {}};
  POISE_RETURN_IF_ERROR(CheckBody(person));
  if (person.clip->num_frames() != frames) {
    return Malformed(
        file, fmt::format("{} frames, the table says {}", person.clip->num_frames(), frames));
  }
  motion::WorldPoses poses = motion::ForwardKinematics(*person.clip);
  person.joints = std::move(poses.positions);
  for (Vec3& joint : person.joints) joint = GroundFromWorld(joint);
  // Turned back to Z up, together with the rest pose where that was turned.
  const math::Quat ground_from_world(math::Quat::FromTwoVectors(Vec3::UnitY(), Vec3::UnitZ()));
  person.rotations = std::move(poses.rotations);
  for (math::Quat& rotation : person.rotations) {
    rotation = ground_from_world * rotation;
    if (read.convention.rest_pose_turned) rotation = rotation * ground_from_world.conjugate();
  }
  return person;
}

// Reads columns group, index, frame and the four forces into the takes of `table`.
Status ReadForces(const fs::path& path, const std::string& group, const std::string& index,
                  const TakeTable& table) {
  POISE_ASSIGN_OR_RETURN(
      const CsvTable csv,
      CsvTable::Read(path, {group, index, "frame", "Fx_N", "Fy_N", "Ftheta_Nm", "Fphi_Nm"}));
  for (int row = 0; row < csv.num_rows(); ++row) {
    const auto found = table.find({std::string(csv.text(row, 0)), csv.integer(row, 1)});
    if (found == table.end()) continue;
    PushTake& take = *found->second;
    if (csv.integer(row, 2) != static_cast<int>(take.force.size())) {
      return Malformed(path.string(),
                       fmt::format("{} has no force for frame {}", take.name(), take.force.size()));
    }
    take.force.emplace_back(csv.number(row, 3), csv.number(row, 4), csv.number(row, 5),
                            csv.number(row, 6));
    if (!take.force.back().allFinite()) {
      return Malformed(path.string(), fmt::format("row {} has no four forces", row + 2));
    }
  }
  for (const auto& [key, take] : table) {
    if (static_cast<int>(take->force.size()) < take->push_frames) {
      return Malformed(path.string(), take->name() + " has fewer forces than push frames");
    }
  }
  return absl::OkStatus();
}

TakeTable TableOf(std::vector<PushTake>& takes) {
  TakeTable table;
  for (PushTake& take : takes) table[{take.group, take.index}] = &take;
  return table;
}

// Adds the people of `takes` as multi/persons.csv lists them.
Status ReadPeople(const fs::path& folder, const TakeTable& takes) {
  POISE_ASSIGN_OR_RETURN(const CsvTable csv, CsvTable::Read(folder / "multi/persons.csv",
                                                            {"group", "take", "person", "file",
                                                             "suit", "mass_kg", "onset_frame_gt"}));
  for (int row = 0; row < csv.num_rows(); ++row) {
    const std::string group(csv.text(row, 0));
    const auto found = takes.find({group, csv.integer(row, 1)});
    if (found == takes.end()) return Malformed("persons.csv", "a take that takes.csv has not");
    PushTake& take = *found->second;
    if (csv.integer(row, 2) != static_cast<int>(take.people.size())) {
      return Malformed("persons.csv", take.name() + " has its people out of order");
    }
    const std::string file = fmt::format("multi/{}/{}/{}", group, take.index, csv.text(row, 3));
    POISE_ASSIGN_OR_RETURN(TakePerson person, ReadPerson(folder, file, take.frames));
    person.suit = std::string(csv.text(row, 4));
    person.mass_kg = csv.number(row, 5);
    person.stated_onset = csv.integer(row, 6);
    take.people.push_back(std::move(person));
  }
  return absl::OkStatus();
}

}  // namespace

StatusOr<std::vector<PushTake>> ReadSingleTakes(const fs::path& folder) {
  POISE_ASSIGN_OR_RETURN(const CsvTable csv,
                         CsvTable::Read(folder / "single/takes.csv",
                                        {"subject", "index", "file", "frames", "split", "session",
                                         "push_level", "mass_kg", "force_frames"}));
  std::vector<PushTake> takes;
  for (int row = 0; row < csv.num_rows(); ++row) {
    PushTake take{.group = std::string(csv.text(row, 0)),
                  .index = csv.integer(row, 1),
                  .split = csv.text(row, 4) == "test" ? Split::kTest : Split::kTrain,
                  .session = std::string(csv.text(row, 5)),
                  .level = std::string(csv.text(row, 6)),
                  .frames = csv.integer(row, 3),
                  .people = {},
                  .force = {},
                  .push_frames = csv.integer(row, 8)};
    const std::string file = fmt::format("single/{}/{}", take.group, csv.text(row, 2));
    POISE_ASSIGN_OR_RETURN(TakePerson person, ReadPerson(folder, file, take.frames));
    person.suit = take.group;
    person.mass_kg = csv.number(row, 7);
    take.people.push_back(std::move(person));
    takes.push_back(std::move(take));
  }
  POISE_RETURN_IF_ERROR(
      ReadForces(folder / "single/forces.csv", "subject", "index", TableOf(takes)));
  return takes;
}

StatusOr<std::vector<PushTake>> ReadMultiTakes(const fs::path& folder) {
  POISE_ASSIGN_OR_RETURN(const CsvTable csv, CsvTable::Read(folder / "multi/takes.csv",
                                                            {"group", "take", "frames", "people",
                                                             "split", "push_frames_used"}));
  std::vector<PushTake> takes;
  for (int row = 0; row < csv.num_rows(); ++row) {
    takes.push_back({.group = std::string(csv.text(row, 0)),
                     .index = csv.integer(row, 1),
                     .split = csv.text(row, 4) == "test" ? Split::kTest : Split::kTrain,
                     .multi = true,
                     .session = "",
                     .level = "",
                     .frames = csv.integer(row, 2),
                     .people = {},
                     .force = {},
                     .push_frames = csv.integer(row, 5)});
  }
  const TakeTable table = TableOf(takes);
  POISE_RETURN_IF_ERROR(ReadPeople(folder, table));
  for (int row = 0; row < csv.num_rows(); ++row) {
    const int people = static_cast<int>(takes[row].people.size());
    if (people != csv.integer(row, 3)) {
      return Malformed(takes[row].name(),
                       fmt::format("{} people, expected {}", people, csv.integer(row, 3)));
    }
  }
  POISE_RETURN_IF_ERROR(ReadForces(folder / "multi/pushes.csv", "group", "take", table));
  return takes;
}

StatusOr<std::vector<PushTake>> ReadTakes(const fs::path& folder) {
  POISE_ASSIGN_OR_RETURN(std::vector<PushTake> takes, ReadSingleTakes(folder));
  POISE_ASSIGN_OR_RETURN(std::vector<PushTake> several, ReadMultiTakes(folder));
  std::move(several.begin(), several.end(), std::back_inserter(takes));
  return takes;
}

std::vector<const PushTake*> TakesOf(const std::vector<PushTake>& takes, Split split) {
  std::vector<const PushTake*> chosen;
  for (const PushTake& take : takes) {
    if (take.split == split) chosen.push_back(&take);
  }
  return chosen;
}

TrainingTakes SplitTraining(const std::vector<PushTake>& takes, int fold) {
  return SplitTakes(TakesOf(takes, Split::kTrain), fold);
}

TrainingTakes SplitTakes(const std::vector<const PushTake*>& training, int fold) {
  const auto session_of = [](const PushTake& take) { return take.group + take.session; };
  std::map<std::string, int> sessions;
  for (const PushTake* take : training) ++sessions[session_of(*take)];
  const bool few = std::any_of(sessions.begin(), sessions.end(),
                               [](const auto& session) { return session.second == 1; });
  const auto set_of = [&](const PushTake& take) { return few ? take.group : session_of(take); };
  std::map<std::string, int> sizes, seen;  // of each set: training takes, and those so far
  for (const PushTake* take : training) ++sizes[set_of(*take)];
  TrainingTakes split;
  for (const PushTake* take : training) {
    const int size = sizes[set_of(*take)], place = seen[set_of(*take)]++;
    const int every = take->multi ? std::min(size, 6) : size;
    const bool chosen = size > 1 && place % every == (fold + (take->multi ? 2 : 1)) % every;
    (chosen ? split.validation : split.train).push_back(take);
  }
  return split;
}

}  // namespace poise::push
