#ifndef POISE_CORE_MOTION_DATASET_WINDOWS_H_
#define POISE_CORE_MOTION_DATASET_WINDOWS_H_

#include <string>
#include <vector>

#include "core/base/status.h"

namespace poise::motion {

/// Lengths of a window [frames]: what is observed and what is to be predicted.
struct WindowShape {
  int past = 0;
  int future = 0;
  int total() const { return past + future; }
  friend bool operator==(const WindowShape&, const WindowShape&) = default;
};

/// Where the windows of one sequence begin, for a test or for training.
/// Source: reference sec. 1.6 and 1.7.

/// The published test: eight starts drawn with replacement by numpy's generator, which begins anew
/// for each sequence (seed 1234567890). The last possible start is never drawn.
/// Errors: kFailedPrecondition CLIP_TOO_SHORT (not longer than the window).
StatusOr<std::vector<int>> SeededStarts(int num_frames, int window);

/// Every window, one frame apart; none when the sequence is shorter than the window.
std::vector<int> AllStarts(int num_frames, int window);

/// How a predictor is tested.
struct EvaluationProtocol {
  std::string name;         ///< "seeded75", ...
  std::vector<int> frames;  ///< output frames that tables show, from 0
  WindowShape window;       ///< decides the starts; the target is its last part
  bool seeded = false;      ///< eight drawn windows, else all of them
};

/// CMU at 60 Hz: "seeded60" (50 in, 10 out), "seeded75" (50 in, 25 out), "all" (every window of 50
/// in, 25 out, so that all models see the same targets). HDM05 at 30 Hz: "loso" (every window of 12
/// in, 12 out of an actor left out of training).
/// Errors: kInvalidArgument UNKNOWN_PROTOCOL, naming the known ones.
StatusOr<EvaluationProtocol> FindProtocol(std::string_view name);

/// The starts that a protocol tests. Errors: those of SeededStarts.
StatusOr<std::vector<int>> TestStarts(const EvaluationProtocol& protocol, int num_frames);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_DATASET_WINDOWS_H_
