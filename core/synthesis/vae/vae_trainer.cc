#include "core/synthesis/vae/vae_trainer.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/base/version.h"
#include "core/learning/nn/guard.h"
#include "core/learning/nn/module_state.h"
#include "core/learning/nn/trainer.h"
#include "core/motion/joint_roles.h"
#include "core/motion/skeleton_json.h"
#include "core/synthesis/vae/vae_loss_net.h"
#include "core/synthesis/vae/vae_net.h"
#include "core/synthesis/vae/vae_tensors_net.h"

namespace poise::synthesis {
namespace {

using learning::Batch;
using learning::Loss;

enum Stream : uint64_t { kFirstWeights, kTraining };

int LongestFrames(const std::vector<PreparedMotion>& motions) {
  Eigen::Index longest = 0;
  for (const PreparedMotion& motion : motions) {
    for (const motion::PoseMatrix& poses : motion.phases) longest = std::max(longest, poses.rows());
  }
  return static_cast<int>(longest);
}

// Lets a gradient pass through a network without asking for that of its weights.
class Frozen {
 public:
  explicit Frozen(torch::nn::Module& module) : parameters_(module.parameters()) { Set(false); }
  ~Frozen() { Set(true); }
  Frozen(const Frozen&) = delete;
  Frozen& operator=(const Frozen&) = delete;

 private:
  void Set(bool requires_grad) {
    for (torch::Tensor& parameter : parameters_) parameter.requires_grad_(requires_grad);
  }
  std::vector<torch::Tensor> parameters_;
};

// The first phase of each motion.
MotionBatch StackFirst(const std::vector<PreparedMotion>& motions, int frames,
                       const RootScale& root) {
  std::vector<const motion::PoseMatrix*> first;
  for (const PreparedMotion& motion : motions) first.push_back(&motion.phases.front());
  return StackMotions(first, frames, root);
}

// The networks, and what passes between them within a step.
class VaeLearner {
 public:
  VaeLearner(const VaeConfig& config, std::vector<PreparedMotion> motions)
      : config_(config),
        motions_(std::move(motions)),
        root_(MakeRootScale(config.root_unit, motions_)),
        frames_(LongestFrames(motions_)),
        width_(static_cast<int>(motions_.front().phases.front().cols())),
        net_(std::make_shared<VaeNet>(config.net, frames_, width_)),
        frame_judge_(std::make_shared<FrameDiscriminator>(config.net, width_)),
        sequence_judge_(std::make_shared<SequenceDiscriminator>(config.net, frames_, width_)) {}

  learning::TrainingSetup Setup(uint64_t seed) {
    learning::TrainingSetup setup;
    setup.num_samples = static_cast<int64_t>(motions_.size());
    setup.seed = seed;
    setup.networks.push_back({"vae", net_, config_.vae_optimizer,
                              [this](const Batch& batch) { return VaeLoss(batch); }});
    if (!config_.adversarial) return setup;
    setup.networks.push_back({"frame_discriminator", frame_judge_, config_.discriminator_optimizer,
                              [this](const Batch&) { return FrameJudgeLoss(); }});
    setup.networks.push_back({"sequence_discriminator", sequence_judge_,
                              config_.discriminator_optimizer,
                              [this](const Batch&) { return SequenceJudgeLoss(); }});
    return setup;
  }

  // Mean error of motions that are encoded and decoded.
  PoseError Reconstruct(const std::vector<PreparedMotion>& motions) {
    const torch::NoGradGuard no_gradient;
    const MotionBatch batch = StackFirst(motions, frames_, root_);
    const torch::Tensor made = net_->Decode(net_->Encode(batch.poses, batch.lengths).mean);
    return CompareMotions(batch.poses, made, batch.lengths, root_);
  }

  // Weights, and what each motion was encoded to.
  StatusOr<base::TensorFile> Weights() {
    const torch::NoGradGuard no_gradient;
    base::TensorFile file;
    POISE_RETURN_IF_ERROR(learning::AppendState(*net_, "net/", file));
    const MotionBatch batch = StackFirst(motions_, frames_, root_);
    const LatentGaussian codes = net_->Encode(batch.poses, batch.lengths);
    POISE_ASSIGN_OR_RETURN(file.tensors["latents/mean"], learning::ToRecord(codes.mean));
    POISE_ASSIGN_OR_RETURN(file.tensors["latents/log_variance"],
                           learning::ToRecord(codes.log_variance));
    return file;
  }

  base::Json Normalisation() const {
    return {{"root", root_.ToJson()},
            {"frames", frames_},
            {"skeleton", motion::SkeletonToJson(*motions_.front().skeleton)}};
  }
  const std::vector<PreparedMotion>& motions() const { return motions_; }

 private:
  MotionBatch Draw(const Batch& batch) const {
    std::vector<const motion::PoseMatrix*> chosen;
    for (const int64_t sample : batch.samples) {
      const auto& phases = motions_[sample].phases;
      chosen.push_back(&phases[batch.random.Index(phases.size())]);
    }
    return StackMotions(chosen, frames_, root_);
  }

  StatusOr<Loss> VaeLoss(const Batch& batch) {
    real_ = Draw(batch);
    const LatentGaussian gaussian = net_->Encode(real_.poses, real_.lengths);
    const torch::Tensor z = gaussian.Draw(torch::randn_like(gaussian.mean));
    const torch::Tensor made = net_->Decode(z);
    const torch::Tensor length = net_->EstimateLength(z);
    const torch::Tensor valid = ValidFrames(real_.lengths, frames_, made.options());
    const DecodedPoses decoded = DecodeColumns(made);
    Loss loss;
    const auto add = [&](const char* name, double weight, const torch::Tensor& term) {
      loss.terms[name] = term.item<double>();
      loss.total = loss.total.defined() ? loss.total + weight * term : weight * term;
    };
    add("reconstruction", 1, ReconstructionLoss(DecodeColumns(real_.poses), decoded, valid));
    add("smoothness", config_.smoothness_weight, SmoothnessLoss(decoded, valid));
    add("kl", config_.kl_weight, KlLoss(gaussian));
    add("length", config_.length_weight, LengthLoss(length, real_.lengths));
    made_ = made.detach();
    made_lengths_ = length.detach().round().clamp(1, frames_).to(torch::kInt64);
    if (!config_.adversarial) return loss;
    const Frozen frame_judge(*frame_judge_), sequence_judge(*sequence_judge_);
    add("frame_adversary", config_.frame_adversary_weight, -frame_judge_->forward(made).mean());
    add("sequence_adversary", config_.sequence_adversary_weight,
        -sequence_judge_->forward(made, made_lengths_).mean());
    return loss;
  }

  StatusOr<Loss> FrameJudgeLoss() {
    return Loss{.total = DiscriminatorLoss(frame_judge_->forward(real_.poses),
                                           frame_judge_->forward(made_))};
  }

  // Real and made motions as one batch: its matrix products are twice as wide.
  StatusOr<Loss> SequenceJudgeLoss() {
    const torch::Tensor verdicts = sequence_judge_->forward(
        torch::cat({real_.poses, made_}), torch::cat({real_.lengths, made_lengths_}));
    const auto halves = verdicts.chunk(2);
    return Loss{.total = DiscriminatorLoss(halves[0], halves[1])};
  }

  const VaeConfig config_;
  const std::vector<PreparedMotion> motions_;
  const RootScale root_;
  const int frames_, width_;
  std::shared_ptr<VaeNet> net_;
  std::shared_ptr<FrameDiscriminator> frame_judge_;
  std::shared_ptr<SequenceDiscriminator> sequence_judge_;
  // Of the present step.
  MotionBatch real_;
  torch::Tensor made_, made_lengths_;
};

api::ModelCard MakeCard(const VaeTask& task, uint64_t seed) {
  VaeConfig config = task.config;
  api::ModelCard card;
  card.family = "vae";
  card.preset = task.preset;
  card.config = base::FieldsToJson(config.Fields());
  card.signature = {.roles = motion::RequiredRoles(),
                    .rotation = motion::RotationRepresentation::kSixD,
                    .with_root_position = true,
                    .frame_rate = config.frame_rate};
  card.data = task.data;
  card.data_fingerprint = task.data_fingerprint;
  card.data_license = task.data_license;
  card.seed = seed;
  card.program_version = base::Version();
  return card;
}

StatusOr<VaeResult> Train(const VaeTask& task, const base::RunContext& context,
                          const std::optional<std::string>& checkpoint,
                          const learning::CheckpointSink& sink) {
  POISE_RETURN_IF_ERROR(task.config.Validate());
  POISE_ASSIGN_OR_RETURN(Fold fold, PrepareFold(task.clips, task.fold, task.config.frame_rate));
  learning::SeedTorch(base::DeriveSeed(context.seed, {kFirstWeights}));
  VaeLearner learner(task.config, std::move(fold.train));
  POISE_ASSIGN_OR_RETURN(
      const std::unique_ptr<learning::Trainer> trainer,
      learning::Trainer::Create(learner.Setup(base::DeriveSeed(context.seed, {kTraining})),
                                task.config.trainer));
  if (checkpoint) POISE_RETURN_IF_ERROR(trainer->Restore(*checkpoint));
  POISE_ASSIGN_OR_RETURN(const learning::TrainingReport report, trainer->Run(context, sink));

  VaeResult result;
  POISE_ASSIGN_OR_RETURN(result.model.weights, learner.Weights());
  api::ModelCard& card = result.model.card;
  card = MakeCard(task, context.seed);
  card.normalisation = learner.Normalisation();
  card.trained_on = fold.description;
  card.steps = report.steps;
  const PoseError error = learner.Reconstruct(learner.motions());
  card.scores["reconstruction_rad"] = error.rotation_rad;
  card.scores["reconstruction_m"] = error.root_m;
  if (!fold.held_out.empty()) {
    const PoseError held_out = learner.Reconstruct(fold.held_out);
    card.scores["held_out_reconstruction_rad"] = held_out.rotation_rad;
    card.scores["held_out_reconstruction_m"] = held_out.root_m;
  }
  card.weights_sha256 = artifacts::WeightsDigest(result.model.weights);
  result.curve_csv = trainer->curve().ToCsv();
  result.curve_svg = trainer->curve().ToSvg("VAE, " + fold.description);
  return result;
}

}  // namespace

StatusOr<VaeResult> TrainVae(const VaeTask& task, const base::RunContext& context,
                             const std::optional<std::string>& checkpoint,
                             const learning::CheckpointSink& sink) {
  return learning::Guard("VAE", [&] { return Train(task, context, checkpoint, sink); });
}

}  // namespace poise::synthesis
