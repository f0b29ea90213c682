#include "core/learning/nn/trainer.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "core/learning/nn/guard.h"
#include "core/learning/nn/module_state.h"
#include "core/learning/nn/sample_order.h"
#include "core/learning/nn/torch_threads.h"
#include "core/learning/nn/trainer_state.h"

namespace poise::learning {
namespace {

using Clock = std::chrono::steady_clock;

// Random streams of a run, apart from each other.
enum Stream : uint64_t { kOrder, kStep, kTorch };

constexpr double kReportSeconds = 0.5;

double SecondsSince(Clock::time_point time) {
  return std::chrono::duration<double>(Clock::now() - time).count();
}

Status NotFinite(const std::string& network, const std::string& term, int64_t step) {
  return base::MakeError(
      absl::StatusCode::kOutOfRange, "NOT_FINITE", "",
      fmt::format("network '{}', step {}: the loss '{}' is not finite", network, step, term));
}

}  // namespace

class Trainer::Implementation {
 public:
  Implementation(TrainingSetup setup, const TrainerConfig& config)
      : setup_(std::move(setup)),
        config_(config),
        order_(setup_.num_samples, config.batch_size, config.with_replacement,
               base::DeriveSeed(setup_.seed, {kOrder})) {
    for (TrainedNetwork& network : setup_.networks) {
      optimizers_.emplace_back(*network.module, network.optimizer);
    }
  }

  StatusOr<TrainingReport> Run(const base::RunContext& context, const CheckpointSink& sink) {
    SetTorchThreads(config_.threads);
    SetTraining(true);
    began_ = last_report_ = last_checkpoint_ = Clock::now();
    first_step_ = state_.report.steps;
    seconds_before_ = state_.report.seconds;
    checkpoint_seconds_ = 0;
    while (StopReason().empty()) {
      if (const Status stop = context.Check(); !stop.ok()) {
        POISE_RETURN_IF_ERROR(SaveCheckpoint(sink));
        return stop;
      }
      POISE_RETURN_IF_ERROR(TrainStep());
      const int64_t done = ++state_.report.steps;
      state_.report.seconds = seconds_before_ + SecondsSince(began_);
      if (done % config_.curve_every == 0 || done == config_.steps) AddCurveRow();
      if (setup_.validate && (done % config_.validate_every == 0 || done == config_.steps)) {
        POISE_RETURN_IF_ERROR(Validate());
      }
      if (SecondsSince(last_report_) >= kReportSeconds || done == config_.steps) Report(context);
      if (CheckpointIsDue(sink)) POISE_RETURN_IF_ERROR(SaveCheckpoint(sink));
    }
    state_.report.stopped_by = StopReason();
    return Finish();
  }

  StatusOr<std::string> Checkpoint() const {
    return EncodeCheckpoint(state_, Identity(), setup_.networks, optimizers_);
  }

  Status Restore(std::string_view checkpoint) {
    POISE_ASSIGN_OR_RETURN(state_,
                           DecodeCheckpoint(checkpoint, Identity(), setup_.networks, optimizers_));
    return absl::OkStatus();
  }

  const LearningCurve& curve() const { return state_.curve; }

 private:
  // What decides the weights: a run resumed under another one would be neither of the two.
  base::Json Identity() const {
    TrainerConfig config = config_;
    base::Json identity = base::FieldsToJson(config.Fields());
    identity.erase("max_seconds");
    identity["seed"] = setup_.seed;
    identity["num_samples"] = setup_.num_samples;
    for (const TrainedNetwork& network : setup_.networks) {
      OptimizerConfig optimizer = network.optimizer;
      identity[network.name] = base::FieldsToJson(optimizer.Fields());
    }
    return identity;
  }

  // Empty while training goes on.
  std::string StopReason() const {
    if (state_.report.steps >= config_.steps) return "steps";
    if (config_.patience > 0 && state_.failed_validations >= config_.patience) return "patience";
    if (config_.max_seconds > 0 && state_.report.seconds >= config_.max_seconds) {
      return "max_seconds";
    }
    return "";
  }

  void SetTraining(bool training) {
    for (TrainedNetwork& network : setup_.networks) network.module->train(training);
  }

  Status TrainStep() {
    const int64_t step = state_.report.steps;
    const auto number = static_cast<uint64_t>(step);
    SeedTorch(base::DeriveSeed(setup_.seed, {kTorch, number}));
    base::Random random(base::DeriveSeed(setup_.seed, {kStep, number}));
    const Batch batch{.step = step, .samples = order_.Batch(step), .random = random};
    for (size_t i = 0; i < setup_.networks.size(); ++i) {
      const TrainedNetwork& network = setup_.networks[i];
      optimizers_[i].ClearGradients();
      POISE_ASSIGN_OR_RETURN(Loss loss, network.loss(batch));
      loss.terms["loss"] = loss.total.item<double>();
      for (const auto& [name, value] : loss.terms) {
        if (!std::isfinite(value)) return NotFinite(network.name, name, step);
      }
      loss.total.backward();
      const StatusOr<double> norm =
          optimizers_[i].Step(network.optimizer.RateAt(step, config_.steps));
      if (!norm.ok()) {
        return base::Annotate(norm.status(),
                              fmt::format("network '{}', step {}", network.name, step));
      }
      loss.terms["gradient_norm"] = *norm;
      state_.recent.Add(loss.terms, network.name);
    }
    ++state_.recent.count;
    return absl::OkStatus();
  }

  void AddCurveRow() {
    state_.curve.Add({state_.report.steps, state_.recent.Means()});
    state_.recent = {};
  }

  Status Validate() {
    for (const TrainedNetwork& network : setup_.networks) {
      POISE_RETURN_IF_ERROR(CheckFinite(*network.module, network.name));
    }
    SetTraining(false);
    const torch::NoGradGuard no_gradient;
    const StatusOr<double> score = setup_.validate();
    SetTraining(true);
    POISE_RETURN_IF_ERROR(score.status());
    if (!std::isfinite(*score)) return NotFinite("all", "validation", state_.report.steps);
    state_.curve.Add({state_.report.steps, {{"validation", *score}}});
    if (*score < state_.report.best_validation) {
      state_.report.best_validation = *score;
      state_.report.best_step = state_.report.steps;
      state_.failed_validations = 0;
      POISE_ASSIGN_OR_RETURN(state_.best, ReadNetworks(setup_.networks));
    } else {
      ++state_.failed_validations;
    }
    last_validation_ = *score;
    return absl::OkStatus();
  }

  void Report(const base::RunContext& context) {
    last_report_ = Clock::now();
    const int64_t done = state_.report.steps;
    base::Progress progress{.step = done, .total = config_.steps, .message = "training"};
    if (state_.recent.count > 0) {
      progress.metrics = state_.recent.Means();
    } else if (!state_.curve.rows().empty()) {
      progress.metrics = state_.curve.rows().back().values;
    }
    if (state_.report.best_step >= 0) {
      progress.metrics["best_validation"] = state_.report.best_validation;
      if (std::isfinite(last_validation_)) progress.metrics["validation"] = last_validation_;
    }
    const double per_step = SecondsSince(began_) / static_cast<double>(done - first_step_);
    progress.metrics["eta_s"] = per_step * static_cast<double>(config_.steps - done);
    context.Report(progress);
  }

  bool CheckpointIsDue(const CheckpointSink& sink) const {
    const absl::Duration passed = absl::FromChrono(Clock::now() - last_checkpoint_);
    if (passed >= sink.interval) return true;
    return passed >= sink.least_interval && checkpoint_seconds_ < sink.share * SecondsSince(began_);
  }

  Status SaveCheckpoint(const CheckpointSink& sink) {
    const Clock::time_point start = Clock::now();
    last_checkpoint_ = start;
    if (!sink.save) return absl::OkStatus();
    POISE_ASSIGN_OR_RETURN(const std::string bytes, Checkpoint());
    POISE_RETURN_IF_ERROR(sink.save(bytes, state_.report.steps));
    checkpoint_seconds_ += SecondsSince(start);
    return absl::OkStatus();
  }

  StatusOr<TrainingReport> Finish() {
    if (!state_.best.tensors.empty()) {
      POISE_RETURN_IF_ERROR(WriteNetworks(state_.best, setup_.networks));
    }
    for (const TrainedNetwork& network : setup_.networks) {
      POISE_RETURN_IF_ERROR(CheckFinite(*network.module, network.name));
    }
    SetTraining(false);
    return state_.report;
  }

  TrainingSetup setup_;
  const TrainerConfig config_;
  SampleOrder order_;
  std::vector<NetworkOptimizer> optimizers_;
  TrainerState state_;
  double last_validation_ = std::numeric_limits<double>::quiet_NaN();
  // Of the present call of Run.
  Clock::time_point began_, last_report_, last_checkpoint_;
  int64_t first_step_ = 0;
  double seconds_before_ = 0;
  double checkpoint_seconds_ = 0;  // that checkpoints took
};

Trainer::Trainer(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Trainer::~Trainer() = default;

StatusOr<std::unique_ptr<Trainer>> Trainer::Create(TrainingSetup setup,
                                                   const TrainerConfig& config) {
  POISE_RETURN_IF_ERROR(config.Validate());
  if (setup.networks.empty()) {
    return base::InvalidArgument("NO_NETWORKS", "networks", "there is no network to train");
  }
  if (setup.num_samples <= 0) {
    return base::InvalidArgument("NO_SAMPLES", "num_samples", "there is nothing to learn from");
  }
  for (const TrainedNetwork& network : setup.networks) {
    POISE_RETURN_IF_ERROR(base::Annotate(network.optimizer.Validate(), network.name, network.name));
  }
  return std::unique_ptr<Trainer>(
      new Trainer(std::make_unique<Implementation>(std::move(setup), config)));
}

StatusOr<TrainingReport> Trainer::Run(const base::RunContext& context, const CheckpointSink& sink) {
  return Guard("training", [&] { return implementation_->Run(context, sink); });
}

StatusOr<std::string> Trainer::Checkpoint() const {
  return Guard("checkpoint", [&] { return implementation_->Checkpoint(); });
}

Status Trainer::Restore(std::string_view checkpoint) {
  return Guard("checkpoint", [&] { return implementation_->Restore(checkpoint); });
}

const LearningCurve& Trainer::curve() const { return implementation_->curve(); }

void SeedTorch(uint64_t seed) { torch::manual_seed(seed); }

}  // namespace poise::learning
