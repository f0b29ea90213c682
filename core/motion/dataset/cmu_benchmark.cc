#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/motion/dataset/benchmark_clips.h"
#include "core/motion/dataset/column_statistics.h"
#include "core/motion/editing/cut.h"
#include "core/motion/io/clip_file.h"

namespace poise::motion {
namespace {

namespace fs = std::filesystem;

constexpr std::array kActions = {"basketball", "basketball_signal", "directing_traffic",
                                 "jumping",    "running",           "soccer",
                                 "walking",    "washwindow"};
constexpr int kKeptRow = 2;  // every second of 120 Hz: the "25 Hz" of the papers is 60 Hz

// <action>_1.txt, <action>_2.txt, ... in the order of their numbers.
std::vector<fs::path> NumberedFiles(const fs::path& folder, const std::string& action) {
  std::vector<std::pair<int, fs::path>> numbered;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() != ".txt" || !stem.starts_with(action + "_")) continue;
    const std::string digits = stem.substr(action.size() + 1);
    if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos) continue;
    numbered.emplace_back(std::stoi(digits), entry.path());
  }
  std::sort(numbered.begin(), numbered.end());
  std::vector<fs::path> files;
  for (auto& [number, path] : numbered) files.push_back(std::move(path));
  return files;
}

StatusOr<Clip> ReadWholeRate(const fs::path& path) {
  POISE_ASSIGN_OR_RETURN(ClipFile file, ReadClipFile(path));
  return std::move(file.clip);
}

}  // namespace

StatusOr<BenchmarkClips> LoadCmuBenchmark(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    return base::NotFound("FOLDER_NOT_FOUND", "data",
                          fmt::format("no folder '{}'", folder.string()));
  }
  BenchmarkClips clips;
  clips.sense = RotationSense::kRowVectors;
  std::vector<PoseMatrix> training_rows;
  for (const std::string action : kActions) {
    for (const fs::path& path : NumberedFiles(folder / "train" / action, action)) {
      POISE_ASSIGN_OR_RETURN(const Clip clip, ReadWholeRate(path));
      training_rows.push_back(RotationVectors(clip, clips.sense));
      POISE_ASSIGN_OR_RETURN(Clip thinned, TakeEvery(clip, kKeptRow));
      clips.train.push_back({action, "", std::move(thinned)});
    }
    const std::vector<fs::path> tests = NumberedFiles(folder / "test" / action, action);
    if (tests.empty()) continue;
    POISE_ASSIGN_OR_RETURN(const Clip clip, ReadWholeRate(tests.front()));
    POISE_ASSIGN_OR_RETURN(Clip thinned, TakeEvery(clip, kKeptRow));
    clips.test.push_back({action, "", std::move(thinned)});
  }
  if (clips.train.empty() || clips.test.empty()) {
    return base::NotFound(
        "NO_CLIPS", "data",
        fmt::format("'{}' holds no train/<action>/<action>_<k>.txt or no such test files",
                    folder.string()));
  }
  clips.counts = ColumnStatistics::Of(training_rows).moving();
  return clips;
}

}  // namespace poise::motion
