#include "core/motion/dataset/windows.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/motion/dataset/legacy_random.h"

namespace poise::motion {
namespace {

constexpr uint32_t kPublishedSeed = 1234567890;
constexpr int kPublishedDraws = 8;

const std::vector<EvaluationProtocol>& Protocols() {
  static const std::vector<EvaluationProtocol> protocols = {
      {"seeded60", {0, 1, 3, 5, 7, 9}, {.past = 50, .future = 10}, true},
      {"seeded75", {1, 3, 7, 9, 13, 24}, {.past = 50, .future = 25}, true},
      {"all", {1, 3, 7, 9, 13, 24}, {.past = 50, .future = 25}, false},
      {"loso", {2, 5, 8, 11}, {.past = 12, .future = 12}, false},
  };
  return protocols;
}

}  // namespace

StatusOr<std::vector<int>> SeededStarts(int num_frames, int window) {
  if (num_frames <= window) {
    return base::FailedPrecondition(
        "CLIP_TOO_SHORT", "clip",
        fmt::format("{} frames, more than the window's {} are needed", num_frames, window));
  }
  LegacyRandom random(kPublishedSeed);
  std::vector<int> starts(kPublishedDraws);
  for (int& start : starts) start = random.Integer(0, num_frames - window);
  return starts;
}

std::vector<int> AllStarts(int num_frames, int window) {
  std::vector<int> starts(std::max(0, num_frames - window + 1));
  std::iota(starts.begin(), starts.end(), 0);
  return starts;
}

StatusOr<EvaluationProtocol> FindProtocol(std::string_view name) {
  std::string known;
  for (const EvaluationProtocol& protocol : Protocols()) {
    if (protocol.name == name) return protocol;
    known += (known.empty() ? "" : ", ") + protocol.name;
  }
  return base::InvalidArgument("UNKNOWN_PROTOCOL", "protocol",
                               fmt::format("unknown protocol '{}'; there are: {}", name, known));
}

StatusOr<std::vector<int>> TestStarts(const EvaluationProtocol& protocol, int num_frames) {
  if (protocol.seeded) return SeededStarts(num_frames, protocol.window.total());
  return AllStarts(num_frames, protocol.window.total());
}

}  // namespace poise::motion
