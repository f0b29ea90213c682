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
#include "core/synthesis/vae/latent_map.h"
#include "core/synthesis/vae/latent_sampler.h"
#include "core/synthesis/vae/vae_loss_net.h"
#include "core/synthesis/vae/vae_net.h"
#include "core/synthesis/vae/vae_tensors_net.h"

namespace poise::synthesis {
namespace {

using learning::Batch;
using learning::Loss;

enum Stream : uint64_t { kFirstWeights, kTraining, kLatentMap };

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
        sequence_judge_(std::make_shared<SequenceDiscriminator>(config.net, frames_, width_)) {
    if (config_.start_at_mean) StartAtMean();
  }

  learning::TrainingSetup Setup(uint64_t seed) {
    learning::TrainingSetup setup;
    setup.num_samples = static_cast<int64_t>(motions_.size());
    setup.seed = seed;
    setup.networks.push_back({"vae", net_, config_.vae_optimizer, [this](const Batch& batch) {
                                return IsGan() ? GanLoss(batch) : VaeLoss(batch);
                              }});
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
    base::TensorFile file;
    POISE_RETURN_IF_ERROR(learning::AppendState(*net_, "net/", file));
    const LatentGaussian codes = Codes();
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
  bool IsGan() const { return config_.generator == "gan"; }

  // What new motions are drawn near to: of a GAN, whatever the mode, the noise that it learned
  // from.
  LatentGaussian Codes() {
    const torch::NoGradGuard no_gradient;
    if (IsGan()) {
      const torch::Tensor zeros =
          torch::zeros({static_cast<int64_t>(motions_.size()), config_.net.latent});
      return {zeros, zeros};
    }
    const MotionBatch batch = StackFirst(motions_, frames_, root_);
    return net_->Encode(batch.poses, batch.lengths);
  }

 private:
  void StartAtMean() {
    const MotionBatch all = StackFirst(motions_, frames_, root_);
    const torch::Tensor valid = ValidFrames(all.lengths, frames_, all.poses.options());
    const torch::Tensor mean = (all.poses * valid.unsqueeze(2)).flatten(0, 1).sum(0) / valid.sum();
    net_->StartAt(mean, all.lengths.to(torch::kFloat64).mean().item<double>());
  }

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
    if (config_.adversarial) {
      AddAdversaries(made, length.detach().round().clamp(1, frames_).to(torch::kInt64), loss);
    }
    return loss;
  }

  // Source: reference sec. 2.8. The authors' length estimator gets no gradient; here the first
  // number of the noise orders the motions of a batch by length, and the estimator learns which
  // length that is: samples are as long as the training motions, whatever else they are.
  StatusOr<Loss> GanLoss(const Batch& batch) {
    real_ = Draw(batch);
    const int64_t count = real_.lengths.size(0);
    const torch::Tensor z = torch::randn({count, config_.net.latent});
    const torch::Tensor order = z.select(1, 0).argsort();
    const torch::Tensor lengths =
        torch::empty_like(real_.lengths).index_copy(0, order, std::get<0>(real_.lengths.sort()));
    Loss loss;
    const torch::Tensor length_loss = LengthLoss(net_->EstimateLength(z), lengths);
    loss.terms["length"] = length_loss.item<double>();
    loss.total = config_.length_weight * length_loss;
    AddAdversaries(net_->Decode(z), lengths, loss);
    return loss;
  }

  // What the discriminators say of made motions, which they are shown next.
  void AddAdversaries(const torch::Tensor& made, const torch::Tensor& lengths, Loss& loss) {
    made_ = made.detach();
    made_lengths_ = lengths;
    const Frozen frame_judge(*frame_judge_), sequence_judge(*sequence_judge_);
    const torch::Tensor frame = -frame_judge_->forward(made).mean();
    const torch::Tensor sequence = -sequence_judge_->forward(made, lengths).mean();
    loss.terms["frame_adversary"] = frame.item<double>();
    loss.terms["sequence_adversary"] = sequence.item<double>();
    loss.total = loss.total + config_.frame_adversary_weight * frame +
                 config_.sequence_adversary_weight * sequence;
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

Eigen::MatrixXd ToMatrix(const torch::Tensor& rows) {
  using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const torch::Tensor numbers = rows.contiguous();
  return Eigen::Map<const RowMajor>(numbers.data_ptr<float>(), rows.size(0), rows.size(1))
      .cast<double>();
}

std::string DrawLatents(const LatentGaussian& codes, uint64_t seed) {
  constexpr int kSamples = 200;
  const Eigen::MatrixXd means = ToMatrix(codes.mean);
  const LatentSampler sampler(means, ToMatrix(codes.log_variance.exp()), {}, seed);
  Eigen::MatrixXd samples(kSamples, means.cols());
  base::Random random(base::DeriveSeed(seed, {kLatentMap}));
  for (int i = 0; i < kSamples; ++i) samples.row(i) = sampler.Draw(random).transpose();
  return LatentMap(means, sampler.clusters(), samples);
}

api::ModelCard MakeCard(const VaeTask& task, uint64_t seed) {
  VaeConfig config = task.config;
  api::ModelCard card;
  card.family = "vae";  // also of a GAN: its decoder is the same
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

// A GAN has none of these: it encodes nothing.
void AddScores(VaeLearner& learner, const std::vector<PreparedMotion>& held_out,
               api::ModelCard& card) {
  const PoseError error = learner.Reconstruct(learner.motions());
  card.scores["reconstruction_rad"] = error.rotation_rad;
  card.scores["reconstruction_m"] = error.root_m;
  if (held_out.empty()) return;
  const PoseError of_actor = learner.Reconstruct(held_out);
  card.scores["held_out_reconstruction_rad"] = of_actor.rotation_rad;
  card.scores["held_out_reconstruction_m"] = of_actor.root_m;
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
  if (!learner.IsGan()) AddScores(learner, fold.held_out, card);
  card.weights_sha256 = artifacts::WeightsDigest(result.model.weights);
  result.curve_csv = trainer->curve().ToCsv();
  // A network of one latent dimension has no plane.
  if (task.config.net.latent > 1)
    result.latent_map_svg = DrawLatents(learner.Codes(), context.seed);
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
