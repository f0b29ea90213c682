#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "core/motion/dataset/benchmark_clips.h"
#include "core/motion/editing/cut.h"
#include "core/motion/editing/reduce.h"
#include "core/motion/io/clip_file.h"

namespace poise::motion {
namespace {

namespace fs = std::filesystem;

constexpr int kKeptFrame = 4;  // of 120 Hz

std::string ActorOf(const fs::path& path) { return LabelsOf(path.stem().string()).actor; }

// Of one class, or of all where `name` is empty.
StatusOr<std::vector<fs::path>> ClassFiles(const fs::path& folder, const std::string& name) {
  if (!fs::is_directory(folder / name)) {
    return base::NotFound("FOLDER_NOT_FOUND", "data",
                          fmt::format("no folder '{}'", (folder / name).string()));
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder / name)) {
    if (entry.path().extension() == ".amc") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

StatusOr<Clip> ReadReduced(const fs::path& path) {
  POISE_ASSIGN_OR_RETURN(const ClipFile file, ReadClipFile(path));
  POISE_ASSIGN_OR_RETURN(const Clip thinned, TakeEvery(file.clip, kKeptFrame));
  POISE_ASSIGN_OR_RETURN(const JointRoles roles, JointRoles::Detect(*thinned.skeleton()));
  return ReduceToRoles(thinned, roles, ReductionMode::kReference);
}

}  // namespace

StatusOr<std::vector<std::string>> Hdm05Actors(const fs::path& folder,
                                               const std::string& action_class) {
  POISE_ASSIGN_OR_RETURN(const auto files, ClassFiles(folder, action_class));
  std::set<std::string> actors;
  for (const fs::path& path : files) actors.insert(ActorOf(path));
  return std::vector<std::string>(actors.begin(), actors.end());
}

StatusOr<BenchmarkClips> LoadHdm05Benchmark(const fs::path& folder, const std::string& action_class,
                                            const std::string& left_out) {
  POISE_ASSIGN_OR_RETURN(const auto files, ClassFiles(folder, action_class));
  BenchmarkClips clips;
  clips.variant = EulerErrorVariant::kAllColumns;
  clips.counts.assign(3 * kNumRequiredRoles, true);
  for (const fs::path& path : files) {
    POISE_ASSIGN_OR_RETURN(Clip clip, ReadReduced(path));
    const std::string actor = ActorOf(path);
    (actor == left_out ? clips.test : clips.train)
        .push_back({path.parent_path().filename().string(), actor, std::move(clip)});
  }
  if (clips.test.empty() || clips.train.empty()) {
    POISE_ASSIGN_OR_RETURN(const auto actors, Hdm05Actors(folder, action_class));
    return base::NotFound(
        "NO_CLIPS", "left_out",
        fmt::format("leaving out '{}' leaves {} clips to train on and {} to test; actors of {}: {}",
                    left_out, clips.train.size(), clips.test.size(), action_class,
                    fmt::join(actors, ", ")));
  }
  return clips;
}

}  // namespace poise::motion
