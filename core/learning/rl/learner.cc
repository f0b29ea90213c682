#include "core/learning/rl/learner.h"

#include <ATen/ATen.h>
#include <ATen/Parallel.h>

#include <algorithm>
#include <cmath>
#include <latch>
#include <string>
#include <utility>

#include "core/learning/nn/guard.h"
#include "core/learning/nn/sample_order.h"
#include "core/learning/rl/advantage.h"
#include "core/learning/rl/surrogate.h"
#include "core/learning/rl/tensor_record.h"

namespace poise::rl {
namespace {

// Streams of random numbers below the seed.
enum Stream : uint64_t { kActorWeights = 1, kCriticWeights = 2, kShuffle = 3 };

constexpr double kSmallestReturnDeviation = 1e-6;

TrainableMlp MakeNetwork(const NetworkConfig& config, int inputs, int outputs, int tail,
                         base::Random random) {
  std::vector<int> sizes = {inputs};
  const std::vector<int> hidden = config.HiddenSizes().value();  // validated
  sizes.insert(sizes.end(), hidden.begin(), hidden.end());
  sizes.push_back(outputs);
  const Activation activation = config.activation == "tanh" ? Activation::kTanh : Activation::kRelu;
  TrainableMlp network(sizes, activation, tail);
  network.Initialize(random, config.output_scale);
  return network;
}

// How far a schedule is: 0 at no samples, 1 at `length` and later; 0 without a schedule.
double ScheduleShare(int64_t samples, int64_t length) {
  if (length == 0) return 0;
  return std::min(1.0, static_cast<double>(samples) / static_cast<double>(length));
}

// A view of what outlives it.
at::Tensor View(const std::vector<float>& values, at::IntArrayRef shape) {
  return at::from_blob(const_cast<float*>(values.data()), shape, at::kFloat);
}

std::vector<float> ToVector(const at::Tensor& tensor) {
  const float* begin = tensor.data_ptr<float>();
  return {begin, begin + tensor.numel()};
}

double Variance(const at::Tensor& values) {
  return values.to(at::kDouble).var(/*unbiased=*/false).item<double>();
}

}  // namespace

Learner::Learner(int observation_size, int action_size, const PpoConfig& config, uint64_t seed)
    : config_(config),
      seed_(seed),
      actor_(MakeNetwork(config.actor, observation_size, action_size, action_size,
                         base::Random(base::DeriveSeed(seed, {kActorWeights})))),
      critic_(MakeNetwork(config.critic, observation_size, 1, 0,
                          base::Random(base::DeriveSeed(seed, {kCriticWeights})))),
      observations_(observation_size),
      returns_(1) {
  actor_.tail().fill_(std::log(config.noise));
}

StatusOr<Policy> Learner::MakePolicy() const {
  ObservationScale scale = ObservationScale::FromMoments(
      observations_, config_.observation_deviation_min, config_.observation_limit);
  POISE_ASSIGN_OR_RETURN(
      auto network, PolicyNetwork::Create(std::move(scale), actor_.Weights(),
                                          config_.actor.activation == "tanh" ? Activation::kTanh
                                                                             : Activation::kRelu));
  return Policy(std::move(network));
}

at::Tensor Learner::log_deviations() const {
  if (config_.learn_noise) return actor_.tail();
  const double share = ScheduleShare(samples_, config_.noise_samples);
  return at::full_like(actor_.tail(),
                       (1 - share) * std::log(config_.noise) + share * std::log(config_.noise_end));
}

Exploration Learner::exploration() const {
  const double share = ScheduleShare(samples_, config_.exploration_samples);
  return {.deviations = ToVector(log_deviations().exp()),
          .share = (1 - share) * config_.exploration + share * config_.exploration_end};
}

double Learner::learning_rate_factor() const {
  const double share = ScheduleShare(samples_, config_.learning_rate_samples);
  return 1 - share * (1 - config_.learning_rate_end);
}

Learner::ValueScale Learner::value_scale() const {
  if (config_.normalize_returns) {
    return {.offset = returns_.mean[0], .scale = returns_.Deviation(0, kSmallestReturnDeviation)};
  }
  return {.offset = 0.5 * (config_.value_low + config_.value_high),
          .scale = 0.5 * (config_.value_high - config_.value_low)};
}

void Learner::Observe(const Batch& batch) {
  samples_ += batch.rows();
  if (observations_.count < config_.observation_samples) observations_.Add(batch.observations);
}

// Counts the returns, and changes the critic's last layer so that its values stay the same in the
// new unit (PopArt, van Hasselt et al. 2016).
void Learner::Rescale(std::span<const float> returns) {
  const bool first = returns_.count == 0;
  const ValueScale before = value_scale();
  returns_.Add(returns);
  if (first) return;  // the critic has learned nothing to keep
  const ValueScale after = value_scale();
  const TrainableMlp::Layer& last = critic_.layers().back();
  last.weight.mul_(before.scale / after.scale);
  last.bias.mul_(before.scale).add_(before.offset - after.offset).div_(after.scale);
}

std::vector<at::Tensor> Learner::Shuffle(int rows) const {
  learning::SampleOrder order(
      rows, config_.minibatch, /*with_replacement=*/false,
      base::DeriveSeed(seed_, {kShuffle, static_cast<uint64_t>(iterations_)}));
  std::vector<at::Tensor> minibatches;
  for (int64_t step = 0; step < config_.epochs * order.batches_per_epoch(); ++step) {
    const std::span<const int64_t> batch = order.Batch(step);
    minibatches.push_back(at::tensor(at::ArrayRef<int64_t>(batch.data(), batch.size()), at::kLong));
  }
  return minibatches;
}

Learner::Samples Learner::Prepare(const Batch& batch, IterationReport& report) {
  const ObservationScale scale = ObservationScale::FromMoments(
      observations_, config_.observation_deviation_min, config_.observation_limit);
  const int64_t rows = batch.rows(), cuts = static_cast<int64_t>(batch.cut_rows.size());
  const at::Tensor observations = at::empty({rows, batch.observation_size});
  const at::Tensor cut_observations = at::empty({cuts, batch.observation_size});
  const auto apply = [&scale](const std::vector<float>& raw, const at::Tensor& scaled) {
    scale.Apply(raw, {scaled.data_ptr<float>(), static_cast<size_t>(scaled.numel())});
  };
  apply(batch.observations, observations);
  apply(batch.cut_observations, cut_observations);

  const ValueScale unit = value_scale();
  const auto values = [&](const at::Tensor& inputs) {
    return critic_.Evaluate(inputs).mul_(unit.scale).add_(unit.offset).squeeze_(1);
  };
  const at::Tensor old_values = values(observations);
  Advantages advantages =
      EstimateAdvantages(batch, ToVector(old_values), ToVector(values(cut_observations)),
                         config_.discount, config_.trace);
  StandardizeAdvantages(batch, config_.advantage_limit, advantages.advantages);
  at::Tensor returns = View(advantages.returns, {rows, 1}).clone();
  const double variance = Variance(returns);
  report.value_error = variance > 0 ? Variance(returns - old_values.unsqueeze(1)) / variance : 0;
  if (config_.normalize_returns) {
    Rescale(advantages.returns);
  } else {
    returns.clamp_(config_.value_low, config_.value_high);
  }
  const ValueScale new_unit = value_scale();
  return {
      .observations = observations,
      .actions = View(batch.actions, {rows, batch.action_size}),
      .log_probs = View(batch.log_probs, {rows}),
      .weights = at::tensor(at::ArrayRef<uint8_t>(batch.explored), at::kByte).to(at::kFloat),
      .advantages = View(advantages.advantages, {rows}).clone(),
      .targets = returns.sub_(new_unit.offset).div_(new_unit.scale),
      .minibatches = Shuffle(batch.rows()),
  };
}

Status Learner::TrainActor(const Samples& samples, const base::RunContext& context,
                           IterationReport& report) {
  double gradient_sum = 0, clip_sum = 0;
  const double learning_rate = config_.actor.learning_rate * learning_rate_factor();
  const at::Tensor fixed_log_deviations = log_deviations();
  for (const at::Tensor& rows : samples.minibatches) {
    POISE_RETURN_IF_ERROR(context.Check());
    const SurrogateInput input = {.actions = samples.actions.index_select(0, rows),
                                  .log_probs = samples.log_probs.index_select(0, rows),
                                  .advantages = samples.advantages.index_select(0, rows),
                                  .weights = samples.weights.index_select(0, rows)};
    const at::Tensor means = actor_.Forward(samples.observations.index_select(0, rows));
    const Surrogate surrogate = EvaluateSurrogate(
        means, config_.learn_noise ? actor_.tail() : fixed_log_deviations, input, config_);
    report.kl = surrogate.kl;
    if (config_.kl_limit > 0 && surrogate.kl > config_.kl_limit) break;
    actor_.Backward(surrogate.means_gradient);
    if (config_.learn_noise) actor_.gradient_tail().copy_(surrogate.log_deviations_gradient);
    gradient_sum += actor_.Step(config_.actor, learning_rate, config_.gradient_norm);
    clip_sum += surrogate.clip_fraction;
    ++report.actor_steps;
  }
  report.actor_gradient = gradient_sum / std::max(report.actor_steps, 1);
  report.clip_fraction = clip_sum / std::max(report.actor_steps, 1);
  return actor_.CheckFinite("actor");
}

Status Learner::TrainCritic(const Samples& samples, const base::RunContext& context) {
  const double learning_rate = config_.critic.learning_rate * learning_rate_factor();
  for (const at::Tensor& rows : samples.minibatches) {
    POISE_RETURN_IF_ERROR(context.Check());
    const at::Tensor outputs = critic_.Forward(samples.observations.index_select(0, rows));
    // Of half the mean squared error.
    critic_.Backward(
        outputs.sub(samples.targets.index_select(0, rows)).div_(static_cast<double>(rows.numel())));
    critic_.Step(config_.critic, learning_rate, config_.gradient_norm);
  }
  return critic_.CheckFinite("critic");
}

Status Learner::Update(const Batch& batch, base::ThreadPool& pool, const base::RunContext& context,
                       IterationReport& report) {
  // The networks learn side by side, each on one thread: as fast as two threads for each, and the
  // same bit for bit on any machine.
  Status actor, critic;
  std::latch done(2);
  Samples samples;
  POISE_RETURN_IF_ERROR(learning::GuardStatus("update", [&] {
    at::set_num_threads(1);
    samples = Prepare(batch, report);
    return absl::OkStatus();
  }));
  pool.Submit([&] {
    critic = learning::GuardStatus("critic", [&] {
      at::set_num_threads(1);
      return TrainCritic(samples, context);
    });
    done.count_down();
  });
  pool.Submit([&] {
    actor = learning::GuardStatus("actor", [&] {
      at::set_num_threads(1);
      return TrainActor(samples, context, report);
    });
    done.count_down();
  });
  done.wait();
  POISE_RETURN_IF_ERROR(actor);
  POISE_RETURN_IF_ERROR(critic);
  // Only now: the policy that took the actions is the one that learned from them.
  Observe(batch);
  ++iterations_;
  return absl::OkStatus();
}

Learner Learner::Clone() const {
  Learner clone = *this;
  clone.actor_ = actor_.Clone();
  clone.critic_ = critic_.Clone();
  return clone;
}

// What the networks do not hold, as views by name.
std::vector<std::pair<std::string, at::Tensor>> Learner::Sums() const {
  const auto view = [](const auto& values, int64_t count, at::ScalarType type) {
    return at::from_blob(const_cast<void*>(static_cast<const void*>(values)), {count}, type);
  };
  std::vector<std::pair<std::string, at::Tensor>> sums = {
      {"iterations", view(&iterations_, 1, at::kLong)}, {"samples", view(&samples_, 1, at::kLong)}};
  for (const auto& [name, moments] :
       {std::pair<std::string, const RunningMoments*>("observations", &observations_),
        {"returns", &returns_}}) {
    sums.emplace_back(name + ".count", view(&moments->count, 1, at::kLong));
    sums.emplace_back(name + ".mean",
                      view(moments->mean.data(), moments->dimensions(), at::kDouble));
    sums.emplace_back(name + ".squares",
                      view(moments->squares.data(), moments->dimensions(), at::kDouble));
  }
  return sums;
}

void Learner::Save(base::TensorFile& file) const {
  actor_.Save("actor", file);
  critic_.Save("critic", file);
  for (const auto& [name, view] : Sums()) file.tensors[name] = ToRecord(view);
}

Status Learner::Restore(const base::TensorFile& file) {
  POISE_RETURN_IF_ERROR(actor_.Restore("actor", file));
  POISE_RETURN_IF_ERROR(critic_.Restore("critic", file));
  for (const auto& [name, view] : Sums()) POISE_RETURN_IF_ERROR(CopyRecord(file, name, view));
  return absl::OkStatus();
}

}  // namespace poise::rl
