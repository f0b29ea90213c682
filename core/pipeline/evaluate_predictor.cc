#include "core/pipeline/evaluate_predictor.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/motion/editing/cut.h"

namespace poise::pipeline {
namespace {

using motion::LabelledClip;
using motion::WindowShape;
using prediction::Observation;

constexpr size_t kBatch = 64;  // windows predicted at once

// How many frames are predicted of each window.
StatusOr<int> FutureFrames(const prediction::PredictorSignature& signature,
                           const motion::EvaluationProtocol& protocol) {
  const WindowShape& window = protocol.window;
  if (signature.past_frames > window.past) {
    return base::FailedPrecondition(
        "PAST_TOO_LONG", "protocol",
        fmt::format("the model looks at {} frames, protocol {} shows {}", signature.past_frames,
                    protocol.name, window.past));
  }
  const int longest = signature.max_future_frames;
  const int future = longest > 0 ? std::min(longest, window.future) : window.future;
  // Frames beyond the model's horizon are left out of its table, but the first must be there.
  if (future > protocol.frames.front()) return future;
  return base::FailedPrecondition(
      "HORIZON_TOO_SHORT", "protocol",
      fmt::format("the model predicts {} frames, the first that protocol {} shows is number {}",
                  longest, protocol.name, protocol.frames.front() + 1));
}

/// Sums of errors of one action while its windows are tested.
class ActionTest {
 public:
  ActionTest(const prediction::Predictor& predictor, const motion::BenchmarkClips& clips,
             WindowShape window, int future)
      : predictor_(predictor), clips_(clips), window_(window), sums_(future) {}

  Status Run(const motion::Clip& clip, const std::vector<int>& starts,
             const base::RunContext& context) {
    const motion::PoseMatrix vectors = motion::RotationVectors(clip, clips_.sense);
    for (size_t first = 0; first < starts.size(); first += kBatch) {
      POISE_RETURN_IF_ERROR(context.Check());
      const size_t last = std::min(first + kBatch, starts.size());
      const std::vector<int> batch(starts.begin() + first, starts.begin() + last);
      POISE_RETURN_IF_ERROR(RunBatch(clip, vectors, batch, context));
    }
    return absl::OkStatus();
  }

  ActionErrors Result(const std::string& action, bool trained_on) const {
    ActionErrors result{action, windows_, trained_on, sums_};
    for (double& error : result.errors) error /= windows_;
    return result;
  }
  int windows() const { return windows_; }

 private:
  Status RunBatch(const motion::Clip& clip, const motion::PoseMatrix& vectors,
                  const std::vector<int>& starts, const base::RunContext& context) {
    const int past = predictor_.signature().past_frames;
    const int future = static_cast<int>(sums_.size());
    std::vector<Observation> observations;
    for (const int start : starts) {
      POISE_ASSIGN_OR_RETURN(motion::Clip seen,
                             motion::Cut(clip, start + window_.past - past, past));
      observations.push_back({std::move(seen)});
    }
    POISE_ASSIGN_OR_RETURN(const auto futures, predictor_.Predict(observations, future, context));
    for (size_t i = 0; i < starts.size(); ++i) {
      // The columns that count may depend on the whole target, however far the model sees.
      const motion::PoseMatrix target =
          vectors.middleRows(starts[i] + window_.past, window_.future);
      motion::PoseMatrix predicted = target;
      predicted.topRows(future) = motion::RotationVectors(futures[i], clips_.sense);
      POISE_ASSIGN_OR_RETURN(const auto errors,
                             motion::EulerErrors(target, predicted, clips_.counts, clips_.variant));
      for (int frame = 0; frame < future; ++frame) sums_[frame] += errors[frame];
      ++windows_;
    }
    return absl::OkStatus();
  }

  const prediction::Predictor& predictor_;
  const motion::BenchmarkClips& clips_;
  const WindowShape window_;
  std::vector<double> sums_;
  int windows_ = 0;
};

Status CheckBenchmark(const prediction::PredictorSignature& signature, const motion::Clip& clip) {
  const bool rate = signature.frame_rate == 0 || signature.frame_rate == clip.frame_rate();
  bool joints = true;
  if (signature.skeleton != nullptr) {
    joints = signature.skeleton->num_joints() == clip.num_joints();
    for (int j = 0; joints && j < clip.num_joints(); ++j) {
      joints = signature.skeleton->joint(j).name == clip.skeleton()->joint(j).name;
    }
  }
  if (rate && joints) return absl::OkStatus();
  return base::FailedPrecondition(
      "WRONG_BENCHMARK", "data",
      fmt::format("the benchmark has {} joints at {} Hz, the model was made for others",
                  clip.num_joints(), clip.frame_rate()));
}

}  // namespace

StatusOr<PredictorScores> EvaluatePredictor(const prediction::Predictor& predictor,
                                            const motion::BenchmarkClips& clips,
                                            const motion::EvaluationProtocol& protocol,
                                            const base::RunContext& context) {
  POISE_ASSIGN_OR_RETURN(const int future, FutureFrames(predictor.signature(), protocol));
  std::set<std::string> trained_on;
  for (const LabelledClip& clip : clips.train) trained_on.insert(clip.action);
  std::map<std::string, ActionTest> tests;
  for (const LabelledClip& test : clips.test) {
    POISE_RETURN_IF_ERROR(CheckBenchmark(predictor.signature(), test.clip));
    POISE_ASSIGN_OR_RETURN(const std::vector<int> starts,
                           motion::TestStarts(protocol, test.clip.num_frames()));
    ActionTest& action =
        tests.try_emplace(test.action, predictor, clips, protocol.window, future).first->second;
    POISE_RETURN_IF_ERROR(base::Annotate(action.Run(test.clip, starts, context), test.clip.name()));
  }
  PredictorScores scores{.actions = {}, .mean = std::vector<double>(future)};
  for (const auto& [name, test] : tests) {
    if (test.windows() > 0) scores.actions.push_back(test.Result(name, trained_on.contains(name)));
  }
  const auto counted = std::count_if(scores.actions.begin(), scores.actions.end(),
                                     [](const ActionErrors& a) { return a.trained_on; });
  for (const ActionErrors& action : scores.actions) {
    if (!action.trained_on) continue;
    for (int frame = 0; frame < future; ++frame) {
      scores.mean[frame] += action.errors[frame] / static_cast<double>(counted);
    }
  }
  return scores;
}

std::string ScoresCsvHeader() {
  return "task,model,preset,protocol,action,frame,horizon_ms,seed,metric,value\n";
}

std::string ScoresCsvRows(const PredictorScores& scores, const ScoreLabels& labels,
                          const motion::EvaluationProtocol& protocol, double frame_rate) {
  std::string rows;
  const auto add = [&](const std::string& action, const std::vector<double>& errors) {
    for (const int frame : protocol.frames) {
      if (frame >= static_cast<int>(errors.size())) continue;
      rows += fmt::format("predict,{},{},{},{},{},{:.1f},{},euler_mae,{:.6f}\n", labels.model,
                          labels.preset, protocol.name, action, frame,
                          1000 * (frame + 1) / frame_rate, labels.seed, errors[frame]);
    }
  };
  for (const ActionErrors& action : scores.actions) add(action.action, action.errors);
  add("mean", scores.mean);
  return rows;
}

}  // namespace poise::pipeline
