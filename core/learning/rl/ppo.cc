#include "core/learning/rl/ppo.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "core/base/tensor_file.h"
#include "core/base/thread_pool.h"
#include "core/learning/nn/torch_threads.h"
#include "core/learning/rl/learner.h"
#include "core/learning/rl/rollout.h"

namespace poise::rl {
namespace {

// Streams of random numbers below the seed; the learner's are smaller numbers.
constexpr uint64_t kRollouts = 100, kWarmup = 101;

constexpr const char* kFingerprint = "fingerprint";

double SecondsSince(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

Status CheckAlike(const std::vector<std::unique_ptr<Environment>>& environments) {
  if (environments.empty()) {
    return base::InvalidArgument("NO_ENVIRONMENT", "environments", "there is no environment");
  }
  const Environment& first = *environments.front();
  for (size_t i = 0; i < environments.size(); ++i) {
    const Environment& other = *environments[i];
    if (other.observation_size() != first.observation_size() ||
        other.action_size() != first.action_size() || other.observation_size() < 1 ||
        other.action_size() < 1) {
      return base::InvalidArgument(
          "ENVIRONMENTS_DIFFER", fmt::format("environments[{}]", i),
          fmt::format("environment {} has {} observations and {} actions, the first {} and {}", i,
                      other.observation_size(), other.action_size(), first.observation_size(),
                      first.action_size()));
    }
  }
  return absl::OkStatus();
}

void Summarize(const Batch& batch, IterationReport& report) {
  double sum = 0;
  for (const float reward : batch.rewards) sum += reward;
  report.reward_mean = sum / batch.rows();
  report.episodes = batch.episodes;
  report.terminated = batch.terminated;
  if (batch.episodes > 0) {
    report.episode_return = batch.return_sum / batch.episodes;
    report.episode_length = static_cast<double>(batch.episode_steps) / batch.episodes;
  }
}

}  // namespace

struct Ppo::State {
  PpoConfig config;
  uint64_t seed;
  RolloutCollector collector;
  base::ThreadPool pool;
  Learner learner;
  Policy policy;

  // What must be the same for a checkpoint to fit.
  std::string Fingerprint() const {
    PpoConfig copy = config;
    copy.threads = 0;  // changes nothing
    return fmt::format("{} seed {} environments {} observations {} actions {}",
                       base::FieldsToJson(copy.Fields()).dump(), seed, collector.slots(),
                       collector.observation_size(), collector.action_size());
  }

  // Whole steps of all environments that make at least `samples`.
  int StepsFor(int samples) const { return (samples + collector.slots() - 1) / collector.slots(); }

  StatusOr<Batch> Collect(const Learner& by, const Policy& with, int samples, uint64_t stream,
                          const base::RunContext& context) {
    const auto iteration = static_cast<uint64_t>(by.iterations());
    return collector.Collect(with, by.exploration(), StepsFor(samples),
                             base::DeriveSeed(seed, {stream, iteration}), pool, context);
  }
};

StatusOr<Ppo> Ppo::Create(std::vector<std::unique_ptr<Environment>> environments,
                          const PpoConfig& config, uint64_t seed) {
  POISE_RETURN_IF_ERROR(config.Validate());
  POISE_RETURN_IF_ERROR(CheckAlike(environments));
  learning::SetTorchThreads(1);
  Learner learner(environments.front()->observation_size(), environments.front()->action_size(),
                  config, seed);
  POISE_ASSIGN_OR_RETURN(Policy policy, learner.MakePolicy());
  return Ppo(std::unique_ptr<State>(new State{
      .config = config,
      .seed = seed,
      .collector = RolloutCollector(std::move(environments), config.environments_per_task),
      .pool = base::ThreadPool(config.threads),
      .learner = std::move(learner),
      .policy = std::move(policy)}));
}

Ppo::Ppo(std::unique_ptr<State> state) : state_(std::move(state)) {}
Ppo::Ppo(Ppo&&) noexcept = default;
Ppo& Ppo::operator=(Ppo&&) noexcept = default;
Ppo::~Ppo() = default;

StatusOr<IterationReport> Ppo::Iterate(const base::RunContext& context) {
  // Everything happens on a copy, which replaces the state at the end.
  const auto begin = std::chrono::steady_clock::now();
  Learner learner = state_->learner.Clone();
  Policy policy = state_->policy;
  if (learner.samples() == 0 && state_->config.warmup_samples > 0) {
    POISE_ASSIGN_OR_RETURN(
        const Batch batch,
        state_->Collect(learner, policy, state_->config.warmup_samples, kWarmup, context));
    learner.Observe(batch);
    POISE_ASSIGN_OR_RETURN(policy, learner.MakePolicy());
  }
  IterationReport report;
  POISE_ASSIGN_OR_RETURN(
      const Batch batch,
      state_->Collect(learner, policy, state_->config.samples_per_update, kRollouts, context));
  Summarize(batch, report);
  for (const float deviation : learner.exploration().deviations) {
    report.noise += deviation / batch.action_size;
  }
  report.collect_seconds = SecondsSince(begin);

  const auto update_begin = std::chrono::steady_clock::now();
  POISE_RETURN_IF_ERROR(learner.Update(batch, state_->pool, context, report));
  POISE_ASSIGN_OR_RETURN(policy, learner.MakePolicy());
  state_->learner = std::move(learner);
  state_->policy = std::move(policy);
  report.iteration = iterations();
  report.samples = samples();
  report.update_seconds = SecondsSince(update_begin);
  return report;
}

Policy Ppo::policy() const { return state_->policy; }
int64_t Ppo::iterations() const { return state_->learner.iterations(); }
int64_t Ppo::samples() const { return state_->learner.samples(); }

std::string Ppo::Save() const {
  base::TensorFile file;
  state_->learner.Save(file);
  file.metadata[kFingerprint] = state_->Fingerprint();
  return base::EncodeTensors(file);
}

Status Ppo::Restore(std::string_view bytes) {
  const auto malformed = [](const Status& status) {
    return base::InvalidArgument("MALFORMED_CHECKPOINT", "", base::Message(status));
  };
  const StatusOr<base::TensorFile> file = base::DecodeTensors(bytes, "checkpoint");
  if (!file.ok()) return malformed(file.status());
  const auto fingerprint = file->metadata.find(kFingerprint);
  if (fingerprint == file->metadata.end()) {
    return malformed(absl::InvalidArgumentError("checkpoint: it has no fingerprint"));
  }
  if (fingerprint->second != state_->Fingerprint()) {
    return base::FailedPrecondition("CHECKPOINT_DIFFERS", "",
                                    fmt::format("the checkpoint is of {}, this run of {}",
                                                fingerprint->second, state_->Fingerprint()));
  }
  Learner learner = state_->learner.Clone();
  if (const Status status = learner.Restore(*file); !status.ok()) return malformed(status);
  StatusOr<Policy> policy = learner.MakePolicy();
  if (!policy.ok()) return malformed(policy.status());
  state_->learner = std::move(learner);
  state_->policy = *std::move(policy);
  return absl::OkStatus();
}

}  // namespace poise::rl
