#include "core/prediction/training/train_predictor.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/base/random.h"
#include "core/base/version.h"
#include "core/learning/nn/guard.h"
#include "core/learning/nn/module_state.h"
#include "core/learning/nn/trainer.h"
#include "core/motion/dataset/windows.h"
#include "core/prediction/gcn/gcn_net.h"
#include "core/prediction/mixer/mixer_net.h"
#include "core/prediction/network_body.h"
#include "core/prediction/potr/potr_net.h"
#include "core/prediction/rnn/rnn_net.h"
#include "core/prediction/simlpe/simlpe_net.h"
#include "core/prediction/tensors/ensemble_net.h"
#include "core/prediction/training/training_clips.h"

namespace poise::prediction {
namespace {

constexpr size_t kFitWindows = 2000;  // from which scales are taken
constexpr int kValidationStep = 5;    // [frames] between the windows that weights are chosen by
constexpr size_t kValidationBatch = 256;
enum Stream : uint64_t { kFit = 1 };  // random streams beside the trainer's

EulerMeasure MeasureOf(const motion::BenchmarkClips& clips, const NetworkBody& body) {
  std::vector<float> counts;
  for (const int joint : body.joints) {
    for (int axis = 0; axis < 3; ++axis) counts.push_back(clips.counts[3 * joint + axis] ? 1 : 0);
  }
  return {.row_vectors = clips.sense == motion::RotationSense::kRowVectors,
          .moving_only = clips.variant == motion::EulerErrorVariant::kMovingColumns,
          .counts = torch::tensor(counts)};
}

std::vector<int> Starts(const motion::Clip& clip, int window, int step) {
  std::vector<int> starts;
  for (const int start : motion::AllStarts(clip.num_frames(), window)) {
    if (start % step == 0) starts.push_back(start);
  }
  return starts;
}

/// Windows to learn from. Balanced, every sequence is drawn as often as any other, however long it
/// is (of CMU two of eight actions have two thirds of the frames), then one of its variants, then a
/// window; else every window equally often.
class TrainingWindows {
 public:
  /// `spare` of a window's frames may lie after the end of its sequence.
  TrainingWindows(const TrainingClips& clips, int window, int spare, bool balanced)
      : windows_(window), balanced_(balanced) {
    for (const std::vector<motion::Clip>& variants : clips.train) {
      std::vector<Range>& ranges = sequences_.emplace_back();
      for (const motion::Clip& clip : variants) {
        const int64_t first = windows_.size();
        windows_.Add(clip, Starts(clip, window - spare, 1));
        ranges.push_back({first, windows_.size() - first});
      }
    }
  }

  int64_t size() const { return windows_.size(); }
  Status AppendTo(base::TensorFile& file, std::string_view prefix) const {
    return windows_.AppendTo(file, prefix);
  }
  PoseTensors Draw(size_t count, base::Random& random) const {
    std::vector<int64_t> chosen(count);
    for (int64_t& window : chosen) {
      if (!balanced_) {
        window = static_cast<int64_t>(random.Index(windows_.size()));
        continue;
      }
      const std::vector<Range>& ranges = sequences_[random.Index(sequences_.size())];
      const Range& range = ranges[random.Index(ranges.size())];
      window = range.first + static_cast<int64_t>(random.Index(range.count));
    }
    return windows_.Gather(chosen);
  }

 private:
  struct Range {
    int64_t first, count;
  };
  PoseWindows windows_;
  const bool balanced_;
  std::vector<std::vector<Range>> sequences_;
};

// Mean Euler error over windows and frames.
double ValidationError(PredictorNet& net, const PoseWindows& windows, const EulerMeasure& measure,
                       const NetworkBody& body) {
  const torch::Tensor joints =
      torch::tensor(std::vector<int64_t>(body.joints.begin(), body.joints.end()));
  std::vector<int64_t> all(windows.size());
  std::iota(all.begin(), all.end(), 0);
  double sum = 0;
  for (size_t first = 0; first < all.size(); first += kValidationBatch) {
    const PoseTensors batch = windows.Gather(
        std::span(all).subspan(first, std::min(kValidationBatch, all.size() - first)));
    sum += measure
               .Errors(net.Predict(batch).rotations.index_select(2, joints),
                       batch.rotations.slice(1, net.past_frames()).index_select(2, joints))
               .mean(1)
               .sum()
               .item<double>();
  }
  return sum / static_cast<double>(all.size());
}

std::shared_ptr<PredictorNet> MakeMember(const PredictorTraining& config, const NetworkBody& body,
                                         const EulerMeasure& measure) {
  if (config.family == "gcn") return std::make_shared<GcnNet>(config.gcn, body, measure);
  if (config.family == "rnn") return std::make_shared<RnnNet>(config.rnn, body, measure);
  if (config.family == "potr") return std::make_shared<PotrNet>(config.potr, body, measure);
  if (config.family == "simlpe") return std::make_shared<SimlpeNet>(config.simlpe, body, measure);
  return std::make_shared<MixerNet>(config.mixer, body, measure);
}

std::shared_ptr<PredictorNet> MakeNet(const PredictorTraining& config, const NetworkBody& body,
                                      const EulerMeasure& measure) {
  if (config.members == 1) return MakeMember(config, body, measure);
  std::vector<std::shared_ptr<PredictorNet>> members;
  for (int i = 0; i < config.members; ++i) members.push_back(MakeMember(config, body, measure));
  return std::make_shared<EnsembleNet>(std::move(members));
}

api::ModelCard MakeCard(const PredictorTask& task, const NetworkBody& body, uint64_t seed) {
  PredictorTraining config = task.config;
  api::ModelCard card;
  card.family = config.family;
  card.preset = task.preset;
  card.config = base::FieldsToJson(config.Fields());
  card.signature = body.Signature();
  card.normalisation = {{"body", body.ToJson()}};
  card.data = task.data;
  card.data_fingerprint = task.data_fingerprint;
  card.trained_on = task.trained_on;
  card.data_license = task.data_license;
  card.seed = seed;
  card.program_version = base::Version();
  return card;
}

/// What learns, and from what.
struct Lesson {
  NetworkBody body;
  EulerMeasure measure;
  TrainingWindows train;
  PoseWindows validation;
  std::shared_ptr<PredictorNet> net;  // before its first step
};

StatusOr<Lesson> Begin(const PredictorTask& task, uint64_t seed) {
  const motion::BenchmarkClips& clips = task.clips;
  PredictorTraining config = task.config;
  POISE_RETURN_IF_ERROR(config.Validate());
  const auto [past_frames, future_frames] = config.frames();
  const int window = past_frames + future_frames;
  POISE_ASSIGN_OR_RETURN(
      const TrainingClips split,
      SplitForTraining(clips,
                       {.window = window,
                        .validation_share = config.validation_share,
                        .mirror = config.mirror,
                        .speeds = config.speeds,
                        .drop_first_frame = clips.sense == motion::RotationSense::kRowVectors}));
  NetworkBody body = NetworkBody::Of(clips);
  const EulerMeasure measure = MeasureOf(clips, body);
  const int spare = std::max(0, future_frames - config.least_future_frames);
  TrainingWindows train(split, window, spare, config.balanced);
  PoseWindows validation(window);
  for (const motion::Clip& clip : split.validation) {
    validation.Add(clip, Starts(clip, window, kValidationStep));
  }
  learning::SeedTorch(seed);
  const std::shared_ptr<PredictorNet> net = MakeNet(config, body, measure);
  POISE_RETURN_IF_ERROR(learning::GuardStatus("scales", [&] {
    base::Random random(base::DeriveSeed(seed, {kFit}));
    net->Fit(train.Draw(kFitWindows, random));
    return absl::OkStatus();
  }));
  return Lesson{std::move(body), measure, std::move(train), std::move(validation), net};
}

}  // namespace

StatusOr<PredictorBeginning> BeginPredictor(const PredictorTask& task, uint64_t seed) {
  const PredictorTraining& config = task.config;
  if (config.balanced || config.least_future_frames < config.frames().future) {
    return base::InvalidArgument("CONFIG_VALUE_OUT_OF_RANGE", "balanced",
                                 "only windows inside sequences, each as likely, are written out");
  }
  POISE_ASSIGN_OR_RETURN(const Lesson lesson, Begin(task, seed));
  PredictorBeginning beginning;
  base::TensorFile& file = beginning.windows;
  POISE_RETURN_IF_ERROR(lesson.train.AppendTo(file, "train."));
  if (lesson.validation.size() > 0) {
    POISE_RETURN_IF_ERROR(lesson.validation.AppendTo(file, "validation."));
  }
  const EulerMeasure& measure = lesson.measure;
  const auto flag = [](bool value) {
    return base::TensorRecord::FromFloats({1}, std::vector<float>{value ? 1.0F : 0.0F});
  };
  POISE_ASSIGN_OR_RETURN(file.tensors["counts"], learning::ToRecord(measure.counts));
  file.tensors["row_vectors"] = flag(measure.row_vectors);
  file.tensors["moving_only"] = flag(measure.moving_only);
  POISE_RETURN_IF_ERROR(learning::AppendState(*lesson.net, "", beginning.model.weights));
  beginning.model.card = MakeCard(task, lesson.body, seed);
  return beginning;
}

StatusOr<PredictorResult> TrainPredictor(const PredictorTask& task, const base::RunContext& context,
                                         const std::optional<std::string>& checkpoint,
                                         const learning::CheckpointSink& sink) {
  const PredictorTraining& config = task.config;
  POISE_ASSIGN_OR_RETURN(const Lesson lesson, Begin(task, context.seed));
  learning::TrainingSetup setup{.num_samples = lesson.train.size(), .seed = context.seed};
  setup.networks.push_back(
      {"predictor", lesson.net, config.optimizer,
       [&](const learning::Batch& batch) -> StatusOr<learning::Loss> {
         const size_t windows = batch.samples.size() * config.members;
         return learning::Loss{.total = lesson.net->Loss(lesson.train.Draw(windows, batch.random))};
       }});
  if (lesson.validation.size() > 0) {
    setup.validate = [&]() -> StatusOr<double> {
      return ValidationError(*lesson.net, lesson.validation, lesson.measure, lesson.body);
    };
  }
  POISE_ASSIGN_OR_RETURN(const auto trainer,
                         learning::Trainer::Create(std::move(setup), config.trainer));
  if (checkpoint) POISE_RETURN_IF_ERROR(trainer->Restore(*checkpoint));
  POISE_ASSIGN_OR_RETURN(const learning::TrainingReport report, trainer->Run(context, sink));

  PredictorResult result;
  POISE_RETURN_IF_ERROR(learning::AppendState(*lesson.net, "", result.model.weights));
  api::ModelCard& card = result.model.card;
  card = MakeCard(task, lesson.body, context.seed);
  card.steps = report.steps;
  if (report.best_step >= 0) card.scores["validation_rad"] = report.best_validation;
  card.weights_sha256 = artifacts::WeightsDigest(result.model.weights);
  result.best_step = report.best_step;
  result.seconds = report.seconds;
  result.curve_csv = trainer->curve().ToCsv();
  result.curve_svg = trainer->curve().ToSvg("Predictor: error while learning");
  return result;
}

}  // namespace poise::prediction
