#include "core/learning/rl/rollout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <latch>
#include <numbers>
#include <string_view>
#include <utility>

namespace poise::rl {
namespace {

// A row of a matrix that lies row by row.
std::span<float> Row(std::vector<float>& matrix, int row, int width) {
  return {matrix.data() + static_cast<size_t>(row) * width, static_cast<size_t>(width)};
}

Status CheckFinite(std::span<const float> values, std::string_view name, int slot) {
  const auto bad = std::find_if_not(values.begin(), values.end(),
                                    [](float value) { return std::isfinite(value); });
  if (bad == values.end()) return absl::OkStatus();
  return base::MakeError(
      absl::StatusCode::kOutOfRange, "NOT_FINITE", "",
      fmt::format("{}[{}] of environment {} is {}", name, bad - values.begin(), slot, *bad));
}

// ln of the density of a normal distribution at its mean.
double PeakLogProb(const std::vector<float>& deviations) {
  double sum = 0;
  for (const float deviation : deviations) {
    sum -= std::log(deviation) + 0.5 * std::log(2 * std::numbers::pi);
  }
  return sum;
}

}  // namespace

// What one environment adds to a batch beside its rows.
struct RolloutCollector::SlotSums {
  std::vector<int> cut_rows;
  std::vector<float> cut_observations;
  int episodes = 0;
  int terminated = 0;
  double return_sum = 0;
  int64_t episode_steps = 0;
  // Of the episode that runs.
  double running_return = 0;
  int running_steps = 0;
};

// What one thread of the pool works with.
struct RolloutCollector::Task {
  int first;  // slots first .. last - 1
  int last;
  Policy policy;
  const Exploration* exploration;
  double peak_log_prob;
  const base::RunContext* context;
  std::atomic<bool>* failed;                 // somewhere; the batch is lost
  std::vector<base::Random> randoms = {};    // (slots of the task)
  std::vector<float> observations = {};      // (slots of the task, observation_size)
  std::vector<float> actions = {};           // (slots of the task, action_size)
  std::vector<float> last_observation = {};  // (observation_size) after the last step of a slot
};

RolloutCollector::RolloutCollector(std::vector<std::unique_ptr<Environment>> environments,
                                   int environments_per_task)
    : environments_(std::move(environments)), environments_per_task_(environments_per_task) {}

StatusOr<Batch> RolloutCollector::Collect(Policy policy, const Exploration& exploration, int steps,
                                          uint64_t seed, base::ThreadPool& pool,
                                          const base::RunContext& context) {
  Batch batch(slots(), steps, observation_size(), action_size());
  std::vector<SlotSums> sums(slots());
  const int tasks = (slots() + environments_per_task_ - 1) / environments_per_task_;
  std::vector<Status> statuses(tasks);
  std::atomic<bool> failed = false;
  std::latch done(tasks);
  for (int i = 0; i < tasks; ++i) {
    const int first = i * environments_per_task_;
    Task task{.first = first,
              .last = std::min(first + environments_per_task_, slots()),
              .policy = policy,
              .exploration = &exploration,
              .peak_log_prob = PeakLogProb(exploration.deviations),
              .context = &context,
              .failed = &failed};
    for (int slot = first; slot < task.last; ++slot) {
      task.randoms.emplace_back(base::DeriveSeed(seed, {static_cast<uint64_t>(slot)}));
    }
    pool.Submit([this, i, task, &batch, &sums, &statuses, &failed, &done] {
      statuses[i] = RunTask(task, batch, sums);
      if (!statuses[i].ok()) failed = true;
      done.count_down();
    });
  }
  done.wait();
  for (const Status& status : statuses) POISE_RETURN_IF_ERROR(status);

  for (const SlotSums& slot : sums) {
    batch.cut_rows.insert(batch.cut_rows.end(), slot.cut_rows.begin(), slot.cut_rows.end());
    batch.cut_observations.insert(batch.cut_observations.end(), slot.cut_observations.begin(),
                                  slot.cut_observations.end());
    batch.episodes += slot.episodes;
    batch.terminated += slot.terminated;
    batch.return_sum += slot.return_sum;
    batch.episode_steps += slot.episode_steps;
  }
  return batch;
}

Status RolloutCollector::RunTask(Task task, Batch& batch, std::vector<SlotSums>& sums) {
  const int observation_size = batch.observation_size;
  const int count = task.last - task.first;
  task.observations.resize(static_cast<size_t>(count) * observation_size);
  task.actions.resize(static_cast<size_t>(count) * batch.action_size);
  task.last_observation.resize(observation_size);
  for (int slot = task.first; slot < task.last; ++slot) {
    const auto observation = Row(batch.observations, slot * batch.steps, observation_size);
    POISE_RETURN_IF_ERROR(environments_[slot]->Reset(task.randoms[slot - task.first], observation));
    POISE_RETURN_IF_ERROR(CheckFinite(observation, "observation", slot));
  }
  for (int step = 0; step < batch.steps && !*task.failed; ++step) {
    POISE_RETURN_IF_ERROR(task.context->Check());
    for (int slot = task.first; slot < task.last; ++slot) {
      const auto row = Row(batch.observations, slot * batch.steps + step, observation_size);
      std::copy(row.begin(), row.end(),
                Row(task.observations, slot - task.first, observation_size).begin());
    }
    task.policy.Act(task.observations, count, task.actions);
    for (int slot = task.first; slot < task.last; ++slot) {
      POISE_RETURN_IF_ERROR(RunStep(task, slot, step, batch, sums[slot]));
    }
  }
  return absl::OkStatus();
}

Status RolloutCollector::RunStep(Task& task, int slot, int step, Batch& batch, SlotSums& sums) {
  const int row = slot * batch.steps + step;
  base::Random& random = task.randoms[slot - task.first];
  const auto action = Row(batch.actions, row, batch.action_size);
  const auto mean = Row(task.actions, slot - task.first, batch.action_size);
  std::copy(mean.begin(), mean.end(), action.begin());
  const double share = task.exploration->share;
  batch.explored[row] = share >= 1 || random.Uniform() < share;
  double squares = 0;
  for (int i = 0; batch.explored[row] != 0 && i < batch.action_size; ++i) {
    const double normal = random.Normal();
    squares += normal * normal;
    action[i] += static_cast<float>(task.exploration->deviations[i] * normal);
  }
  batch.log_probs[row] = static_cast<float>(task.peak_log_prob - 0.5 * squares);

  const bool last = step + 1 == batch.steps;
  const auto next = last ? std::span<float>(task.last_observation)
                         : Row(batch.observations, row + 1, batch.observation_size);
  POISE_ASSIGN_OR_RETURN(const Transition transition, environments_[slot]->Step(action, next));
  POISE_RETURN_IF_ERROR(CheckFinite(next, "observation", slot));
  POISE_RETURN_IF_ERROR(CheckFinite({&transition.reward, 1}, "reward", slot));
  batch.rewards[row] = transition.reward;
  sums.running_return += transition.reward;
  ++sums.running_steps;
  const bool ended = transition.terminated || transition.truncated;
  if (!ended && !last) return absl::OkStatus();

  batch.endings[row] = transition.terminated ? Ending::kTerminated : Ending::kTruncated;
  if (!transition.terminated) {
    sums.cut_rows.push_back(row);
    sums.cut_observations.insert(sums.cut_observations.end(), next.begin(), next.end());
  }
  if (ended) {
    ++sums.episodes;
    sums.terminated += transition.terminated ? 1 : 0;
    sums.return_sum += std::exchange(sums.running_return, 0);
    sums.episode_steps += std::exchange(sums.running_steps, 0);
  }
  if (last) return absl::OkStatus();
  POISE_RETURN_IF_ERROR(environments_[slot]->Reset(random, next));
  return CheckFinite(next, "observation", slot);
}

}  // namespace poise::rl
