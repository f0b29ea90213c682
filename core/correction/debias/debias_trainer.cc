#include "core/correction/debias/debias_trainer.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "core/base/version.h"
#include "core/correction/debias/debias_net.h"
#include "core/correction/debias/debiaser.h"
#include "core/learning/nn/guard.h"
#include "core/learning/nn/module_state.h"
#include "core/learning/nn/trainer.h"
#include "core/motion/editing/mirror.h"
#include "core/motion/editing/reduce.h"
#include "core/motion/motion_signature.h"

namespace poise::correction {
namespace {

// Columns that hardly move in training, of inputs and outputs, are not blown up.
constexpr float kLeastInputScale = 1e-2f, kLeastOutputSize = 1e-3f;

enum Stream : uint64_t { kFirstWeights, kTraining };

FrameRows Stack(const std::vector<FrameRows>& blocks) {
  Eigen::Index rows = 0;
  for (const FrameRows& block : blocks) rows += block.rows();
  FrameRows all(rows, blocks.front().cols());
  Eigen::Index row = 0;
  for (const FrameRows& block : blocks) {
    all.middleRows(row, block.rows()) = block;
    row += block.rows();
  }
  return all;
}

torch::Tensor ToTensor(const FrameRows& rows) {
  torch::Tensor tensor = torch::empty({rows.rows(), rows.cols()});
  std::copy(rows.data(), rows.data() + rows.size(), tensor.data_ptr<float>());
  return tensor;
}

base::TensorRecord ToRecord(const Eigen::RowVectorXf& row) {
  return base::TensorRecord::FromFloats({row.size()},
                                        std::span<const float>(row.data(), row.size()));
}

// All frames of all pairs, and what they are measured in.
struct Frames {
  Eigen::RowVectorXf mean, scale;  // of the inputs
  Eigen::RowVectorXf size;         // of the corrections
  torch::Tensor inputs;            // (frames, InputWidth), standardised
  torch::Tensor corrections;       // (frames, kCorrectionWidth), in units of their size

  static Frames Of(const std::vector<DebiasPair>& pairs, const DebiasConfig& config) {
    std::vector<FrameRows> seen, right;
    const auto add = [&](const motion::Clip& imitated, const motion::Clip& original) {
      seen.push_back(MakeFrameRows(imitated, config.input));
      right.push_back(CorrectionBetween(imitated, original));
    };
    for (const DebiasPair& pair : pairs) {
      add(pair.imitated, pair.original);
      if (!config.mirror) continue;
      const auto roles = motion::ReducedRoles(*pair.imitated.skeleton());
      if (!roles.ok()) continue;
      const auto imitated = motion::Mirror(pair.imitated, *roles);
      const auto original = motion::Mirror(pair.original, *roles);
      // A body whose sides are too unlike has no mirror image.
      if (imitated.ok() && original.ok()) add(*imitated, *original);
    }
    FrameRows rows = Stack(seen);
    FrameRows corrections = Stack(right);
    const auto count = static_cast<float>(rows.rows());
    Frames frames;
    frames.mean = rows.colwise().mean();
    rows.rowwise() -= frames.mean;
    frames.scale = (rows.colwise().squaredNorm() / count).cwiseSqrt().cwiseMax(kLeastInputScale);
    rows.array().rowwise() /= frames.scale.array();
    rows = rows.cwiseMax(-kInputLimit).cwiseMin(kInputLimit).eval();
    frames.size =
        (corrections.colwise().squaredNorm() / count).cwiseSqrt().cwiseMax(kLeastOutputSize);
    frames.inputs = ToTensor(rows);
    corrections.array().rowwise() /= frames.size.array();
    frames.corrections = ToTensor(corrections);
    return frames;
  }
};

Status CheckRates(const std::vector<DebiasPair>& pairs) {
  if (pairs.empty()) {
    return base::FailedPrecondition("NOTHING_IMITATED", "",
                                    "the character completed none of the clips");
  }
  for (const DebiasPair& pair : pairs) {
    if (pair.original.frame_rate() != pairs.front().original.frame_rate()) {
      return base::FailedPrecondition(
          "MIXED_RATES", "",
          fmt::format("clip '{}' has {} Hz, clip '{}' {}", pair.original.name(),
                      pair.original.frame_rate(), pairs.front().original.name(),
                      pairs.front().original.frame_rate()));
    }
  }
  return absl::OkStatus();
}

Status AddScores(const Debiaser& debiaser, const std::vector<DebiasPair>& pairs,
                 const std::string& prefix, std::map<std::string, double>& scores) {
  for (const DebiasPair& pair : pairs) {
    POISE_ASSIGN_OR_RETURN(const motion::Clip debiased, debiaser.Apply(pair.imitated, *pair.body));
    const double share = 1.0 / static_cast<double>(pairs.size());
    const PairError before = ErrorBetween(pair.imitated, pair.original);
    const PairError after = ErrorBetween(debiased, pair.original);
    scores[prefix + "imitated_rad"] += share * before.joint_rad;
    scores[prefix + "imitated_m"] += share * before.root_m;
    scores[prefix + "debiased_rad"] += share * after.joint_rad;
    scores[prefix + "debiased_m"] += share * after.root_m;
  }
  return absl::OkStatus();
}

api::ModelCard MakeCard(const DebiasTask& task, double frame_rate, uint64_t seed) {
  DebiasConfig config = task.config;
  api::ModelCard card;
  card.family = Debiaser::kFamily;
  card.preset = task.preset;
  card.config = base::FieldsToJson(config.Fields());
  card.signature = {.roles = motion::RequiredRoles(),
                    .rotation = motion::RotationRepresentation::kSixD,
                    .with_root_position = true,
                    .frame_rate = frame_rate};
  card.data = task.data;
  card.data_fingerprint = task.data_fingerprint;
  card.trained_on = task.trained_on;
  card.data_license = task.data_license;
  card.seed = seed;
  card.program_version = base::Version();
  return card;
}

StatusOr<DebiasResult> Train(const DebiasTask& task, const std::vector<DebiasPair>& train,
                             const std::vector<DebiasPair>& held_out,
                             const base::RunContext& context,
                             const std::optional<std::string>& checkpoint,
                             const learning::CheckpointSink& sink) {
  const DebiasConfig& config = task.config;
  POISE_RETURN_IF_ERROR(config.Validate());
  POISE_RETURN_IF_ERROR(CheckRates(train));
  const Frames frames = Frames::Of(train, config);
  learning::SeedTorch(base::DeriveSeed(context.seed, {kFirstWeights}));
  const auto net = std::make_shared<DebiasNet>(config);
  learning::TrainingSetup setup{.num_samples = frames.inputs.size(0),
                                .seed = base::DeriveSeed(context.seed, {kTraining})};
  setup.networks.push_back(
      {"debias", net, config.optimizer,
       [&](const learning::Batch& batch) -> StatusOr<learning::Loss> {
         const torch::Tensor chosen =
             torch::tensor(std::vector<int64_t>(batch.samples.begin(), batch.samples.end()));
         const torch::Tensor found = net->forward(frames.inputs.index_select(0, chosen));
         const torch::Tensor left = found - frames.corrections.index_select(0, chosen);
         const torch::Tensor loss = left.square().mean() + net->Penalty(config);
         return learning::Loss{.total = loss};
       }});
  POISE_ASSIGN_OR_RETURN(const std::unique_ptr<learning::Trainer> trainer,
                         learning::Trainer::Create(std::move(setup), config.trainer));
  if (checkpoint) POISE_RETURN_IF_ERROR(trainer->Restore(*checkpoint));
  POISE_ASSIGN_OR_RETURN(const learning::TrainingReport report, trainer->Run(context, sink));

  DebiasResult result;
  base::TensorFile& weights = result.model.weights;
  POISE_RETURN_IF_ERROR(learning::AppendState(*net, "", weights));
  weights.tensors["input.mean"] = ToRecord(frames.mean);
  weights.tensors["input.scale"] = ToRecord(frames.scale);
  weights.tensors["output.size"] = ToRecord(frames.size);
  api::ModelCard& card = result.model.card;
  card = MakeCard(task, train.front().original.frame_rate(), context.seed);
  card.steps = report.steps;
  POISE_ASSIGN_OR_RETURN(const DebiaserPtr debiaser, Debiaser::Create(result.model));
  POISE_RETURN_IF_ERROR(AddScores(*debiaser, train, "", card.scores));
  POISE_RETURN_IF_ERROR(AddScores(*debiaser, held_out, "held_out_", card.scores));
  card.weights_sha256 = artifacts::WeightsDigest(weights);
  result.curve_csv = trainer->curve().ToCsv();
  result.curve_svg = trainer->curve().ToSvg("Debiasing, " + task.trained_on);
  return result;
}

}  // namespace

StatusOr<DebiasResult> TrainDebias(const DebiasTask& task, const std::vector<DebiasPair>& train,
                                   const std::vector<DebiasPair>& held_out,
                                   const base::RunContext& context,
                                   const std::optional<std::string>& checkpoint,
                                   const learning::CheckpointSink& sink) {
  return learning::Guard("debiasing",
                         [&] { return Train(task, train, held_out, context, checkpoint, sink); });
}

StatusOr<DebiasResult> TrainDebias(const DebiasTask& task, const base::RunContext& context,
                                   const std::optional<std::string>& checkpoint,
                                   const learning::CheckpointSink& sink) {
  POISE_RETURN_IF_ERROR(task.config.Validate());
  POISE_ASSIGN_OR_RETURN(const CorrectionConfig correction, CorrectionOf(task.config));
  POISE_ASSIGN_OR_RETURN(const std::vector<DebiasPair> train,
                         MakeDebiasPairs(task.train, correction, context));
  POISE_ASSIGN_OR_RETURN(const std::vector<DebiasPair> held_out,
                         MakeDebiasPairs(task.held_out, correction, context));
  return TrainDebias(task, train, held_out, context, checkpoint, sink);
}

}  // namespace poise::correction
