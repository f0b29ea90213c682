#include "core/correction/debias/debias_trainer.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "core/base/version.h"
#include "core/correction/debias/debias_net.h"
#include "core/correction/debias/debiaser.h"
#include "core/correction/debias/ridge.h"
#include "core/learning/nn/guard.h"
#include "core/learning/nn/learning_curve.h"
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

base::TensorRecord ToRecord(const FrameRows& rows) {
  return base::TensorRecord::FromFloats({rows.rows(), rows.cols()},
                                        std::span<const float>(rows.data(), rows.size()));
}

// All frames of all pairs, and what they are measured in.
struct Frames {
  Eigen::RowVectorXf mean, scale;   // of the inputs
  Eigen::RowVectorXf size;          // of the corrections
  std::vector<ActorFrames> actors;  // their inputs standardised

  static Frames Of(const std::vector<DebiasPair>& pairs, const DebiasConfig& config) {
    std::map<std::string, std::pair<std::vector<FrameRows>, std::vector<FrameRows>>> blocks;
    for (const DebiasPair& pair : pairs) {
      auto& [seen, right] = blocks[pair.actor];
      const auto add = [&](const motion::Clip& imitated, const motion::Clip& original) {
        seen.push_back(MakeFrameRows(imitated, config.input));
        right.push_back(CorrectionBetween(imitated, original));
      };
      add(pair.imitated, pair.original);
      if (!config.mirror) continue;
      const auto roles = motion::ReducedRoles(*pair.imitated.skeleton());
      if (!roles.ok()) continue;
      const auto imitated = motion::Mirror(pair.imitated, *roles);
      const auto original = motion::Mirror(pair.original, *roles);
      // A body whose sides are too unlike has no mirror image.
      if (imitated.ok() && original.ok()) add(*imitated, *original);
    }
    Frames frames;
    for (const auto& [actor, rows] : blocks) {
      frames.actors.push_back({Stack(rows.first), Stack(rows.second)});
    }
    frames.Standardise();
    return frames;
  }

  FrameRows AllInputs() const { return All(&ActorFrames::inputs); }
  FrameRows AllCorrections() const { return All(&ActorFrames::corrections); }

 private:
  FrameRows All(FrameRows ActorFrames::*part) const {
    std::vector<FrameRows> blocks;
    for (const ActorFrames& actor : actors) blocks.push_back(actor.*part);
    return Stack(blocks);
  }

  void Standardise() {
    FrameRows rows = AllInputs();
    const FrameRows corrections = AllCorrections();
    const auto count = static_cast<float>(rows.rows());
    mean = rows.colwise().mean();
    rows.rowwise() -= mean;
    scale = (rows.colwise().squaredNorm() / count).cwiseSqrt().cwiseMax(kLeastInputScale);
    size = (corrections.colwise().squaredNorm() / count).cwiseSqrt().cwiseMax(kLeastOutputSize);
    for (ActorFrames& actor : actors) {
      actor.inputs = ((actor.inputs.rowwise() - mean).array().rowwise() / scale.array())
                         .cwiseMax(-kInputLimit)
                         .cwiseMin(kInputLimit)
                         .matrix();
    }
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

// What is learned, before the card's scores.
struct Learned {
  base::TensorFile weights;  // layer0.weight, layer0.bias, ...
  learning::LearningCurve curve;
  int64_t steps = 0;
};

StatusOr<Learned> TrainLayers(const DebiasConfig& config, const Frames& frames,
                              const base::RunContext& context,
                              const std::optional<std::string>& checkpoint,
                              const learning::CheckpointSink& sink) {
  const torch::Tensor inputs = ToTensor(frames.AllInputs());
  const torch::Tensor corrections =
      ToTensor(frames.AllCorrections().array().rowwise() / frames.size.array());
  learning::SeedTorch(base::DeriveSeed(context.seed, {kFirstWeights}));
  const auto net = std::make_shared<DebiasNet>(config);
  learning::TrainingSetup setup{.num_samples = inputs.size(0),
                                .seed = base::DeriveSeed(context.seed, {kTraining})};
  setup.networks.push_back(
      {"debias", net, config.optimizer,
       [&](const learning::Batch& batch) -> StatusOr<learning::Loss> {
         const torch::Tensor chosen =
             torch::tensor(std::vector<int64_t>(batch.samples.begin(), batch.samples.end()));
         const torch::Tensor found = net->forward(inputs.index_select(0, chosen));
         const torch::Tensor left = found - corrections.index_select(0, chosen);
         const torch::Tensor loss = left.square().mean() + net->Penalty(config);
         return learning::Loss{.total = loss};
       }});
  POISE_ASSIGN_OR_RETURN(const std::unique_ptr<learning::Trainer> trainer,
                         learning::Trainer::Create(std::move(setup), config.trainer));
  if (checkpoint) POISE_RETURN_IF_ERROR(trainer->Restore(*checkpoint));
  POISE_ASSIGN_OR_RETURN(const learning::TrainingReport report, trainer->Run(context, sink));
  Learned learned{.weights = {}, .curve = trainer->curve(), .steps = report.steps};
  POISE_RETURN_IF_ERROR(learning::AppendState(*net, "", learned.weights));
  return learned;
}

bool Chooses(const DebiasConfig& config, const Frames& frames) {
  return config.choose_l2 && frames.actors.size() > 1;
}

// The curve is over the candidates, by number.
Learned SolveLinear(const DebiasConfig& config, const Frames& frames) {
  const RidgeFit fit = Chooses(config, frames) ? FitRidgeByActors(frames.actors)
                                               : FitRidge(frames.actors, config.l2_weight);
  Learned learned{.weights = {}, .curve = {}, .steps = 1};
  const FrameRows weight = fit.weight.transpose().cast<float>();
  learned.weights.tensors["layer0.weight"] =
      ToRecord(FrameRows(weight.array().colwise() / frames.size.transpose().array()));
  learned.weights.tensors["layer0.bias"] =
      ToRecord(Eigen::RowVectorXf(fit.bias.cast<float>().array() / frames.size.array()));
  for (size_t i = 0; i < fit.left_out_errors.size(); ++i) {
    learned.curve.Add({.step = static_cast<int64_t>(i),
                       .values = {{"l2_weight", kL2Candidates[i]},
                                  {"left_out_rad", fit.left_out_errors[i]},
                                  {"left_out_uncorrected_rad", fit.left_out_uncorrected}}});
  }
  return learned;
}

artifacts::ModelArtifact MakeModel(base::TensorFile weights, const Frames& frames,
                                   api::ModelCard card) {
  weights.tensors["input.mean"] = ToRecord(frames.mean);
  weights.tensors["input.scale"] = ToRecord(frames.scale);
  weights.tensors["output.size"] = ToRecord(frames.size);
  return {.card = std::move(card), .weights = std::move(weights)};
}

base::TensorFile NoChange(const Frames& frames) {
  const Eigen::Index inputs = frames.mean.size();
  base::TensorFile weights;
  weights.tensors["layer0.weight"] = ToRecord(FrameRows(FrameRows::Zero(kCorrectionWidth, inputs)));
  weights.tensors["layer0.bias"] =
      ToRecord(Eigen::RowVectorXf(Eigen::RowVectorXf::Zero(kCorrectionWidth)));
  return weights;
}

// How far each actor of the training is from his originals after a linear map that learned from
// the others, feet held: `left_out_imitated_rad`, `left_out_debiased_rad`.
Status AddLeftOutScores(const DebiasTask& task, const std::vector<DebiasPair>& train,
                        api::ModelCard& card) {
  std::set<std::string> actors;
  for (const DebiasPair& pair : train) actors.insert(pair.actor);
  for (const std::string& actor : actors) {
    std::vector<DebiasPair> rest, left_out;
    for (const DebiasPair& pair : train) (pair.actor == actor ? left_out : rest).push_back(pair);
    const Frames frames = Frames::Of(rest, task.config);
    const artifacts::ModelArtifact model =
        MakeModel(SolveLinear(task.config, frames).weights, frames, card);
    POISE_ASSIGN_OR_RETURN(const DebiaserPtr debiaser, Debiaser::Create(model));
    std::map<std::string, double> of_actor;
    POISE_RETURN_IF_ERROR(AddScores(*debiaser, left_out, "left_out_", of_actor));
    for (const auto& [name, value] : of_actor) {
      card.scores[name] += value / static_cast<double>(actors.size());
    }
  }
  return absl::OkStatus();
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
  StatusOr<Learned> learned = config.layers == 0
                                  ? SolveLinear(config, frames)
                                  : TrainLayers(config, frames, context, checkpoint, sink);
  POISE_RETURN_IF_ERROR(learned.status());

  api::ModelCard made = MakeCard(task, train.front().original.frame_rate(), context.seed);
  made.steps = learned->steps;
  if (config.layers == 0 && Chooses(config, frames)) {
    POISE_RETURN_IF_ERROR(AddLeftOutScores(task, train, made));
    if (made.scores["left_out_debiased_rad"] >= made.scores["left_out_imitated_rad"]) {
      learned->weights = NoChange(frames);
    }
  }
  DebiasResult result;
  result.model = MakeModel(std::move(learned->weights), frames, std::move(made));
  api::ModelCard& card = result.model.card;
  POISE_ASSIGN_OR_RETURN(const DebiaserPtr debiaser, Debiaser::Create(result.model));
  POISE_RETURN_IF_ERROR(AddScores(*debiaser, train, "", card.scores));
  POISE_RETURN_IF_ERROR(AddScores(*debiaser, held_out, "held_out_", card.scores));
  card.weights_sha256 = artifacts::WeightsDigest(result.model.weights);
  result.curve_csv = learned->curve.ToCsv();
  result.curve_svg = learned->curve.ToSvg("Debiasing, " + task.trained_on);
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
