#include "core/pipeline/correct_run.h"

#include <algorithm>
#include <utility>

#include "absl/time/clock.h"
#include "core/base/thread_pool.h"

namespace poise::pipeline {
namespace {

// Sums of a few variants' scores.
struct Tally {
  double reward = 0;
  double force = 0;
  double torque = 0;
  int count = 0;

  void Add(double more_reward, double more_force, double more_torque) {
    reward += more_reward;
    force += more_force;
    torque += more_torque;
    ++count;
  }
};

double Metric(const base::Progress& progress, const char* name) {
  const auto found = progress.metrics.find(name);
  return found == progress.metrics.end() ? 0 : found->second;
}

// The mean over variants after each rollout; who has ended stays where it is.
std::vector<api::RewardPoint> MeanCurve(const std::vector<const CorrectedVariant*>& variants) {
  size_t longest = 0;
  for (const CorrectedVariant* variant : variants) {
    longest = std::max(longest, variant->curve.size());
  }
  std::vector<api::RewardPoint> curve(longest);
  for (size_t k = 0; k < longest; ++k) {
    Tally tally;
    for (const CorrectedVariant* variant : variants) {
      if (variant->curve.empty()) continue;
      const api::RewardPoint& point = variant->curve[std::min(k, variant->curve.size() - 1)];
      curve[k].samples += point.samples;
      tally.Add(point.reward_normalised, point.residual_force_mean_bw,
                point.residual_torque_mean_nm);
    }
    curve[k].reward_normalised = tally.reward / tally.count;
    curve[k].residual_force_mean_bw = tally.force / tally.count;
    curve[k].residual_torque_mean_nm = tally.torque / tally.count;
  }
  return curve;
}

}  // namespace

CorrectState CorrectState::Empty(const CorrectFlow& flow) {
  CorrectState state;
  state.zero_policies.resize(flow.num_sources());
  state.variants.resize(flow.num_variants());
  return state;
}

CorrectRun::CorrectRun(const CorrectFlow& flow, CorrectRunConfig config, CorrectState state)
    : flow_(flow), config_(std::move(config)), state_(std::move(state)) {
  for (int source = 0; source < flow.num_sources(); ++source) {
    if (!state_.zero_policies[source]) units_.push_back({.is_variant = false, .index = source});
    const int64_t first = int64_t{source} * flow.variants_per_source();
    for (int64_t i = first; i < first + flow.variants_per_source(); ++i) {
      if (!state_.variants[i]) units_.push_back({.is_variant = true, .index = i});
    }
  }
  variants_waiting_ =
      std::count_if(units_.begin(), units_.end(), [](const Unit& unit) { return unit.is_variant; });
  total_ = flow.num_sources() + flow.num_variants() * flow.rollouts();
  step_ = total_;
  for (const Unit& unit : units_) step_ -= unit.is_variant ? flow.rollouts() : 1;
  first_step_ = step_;
}

Status CorrectRun::Run(const base::RunContext& context) {
  context_ = context;
  start_ = absl::Now();
  seconds_before_ = state_.seconds;
  if (config_.max_seconds > 0) {
    time_up_ = start_ + absl::Seconds(config_.max_seconds - seconds_before_);
  }
  threads_ = config_.threads > 0 ? config_.threads : base::AvailableCpus();
  threads_ = std::clamp<int>(threads_, 1, std::max<int>(1, static_cast<int>(units_.size())));
  {
    std::lock_guard lock(mutex_);
    ReportProgress();
  }
  {
    base::ThreadPool pool(threads_);
    for (int i = 0; i < threads_; ++i) pool.Submit([this] { Work(); });
  }
  return status_;
}

void CorrectRun::Work() {
  while (const std::optional<Unit> unit = NextUnit()) {
    Status status =
        unit->is_variant ? DoVariant(unit->index) : DoZeroPolicy(static_cast<int>(unit->index));
    if (status.ok()) continue;
    std::lock_guard lock(mutex_);
    if (status_.ok()) status_ = std::move(status);
  }
}

std::optional<CorrectRun::Unit> CorrectRun::NextUnit() {
  std::lock_guard lock(mutex_);
  if (!status_.ok() || next_unit_ == units_.size()) return std::nullopt;
  return units_[next_unit_++];
}

Status CorrectRun::DoZeroPolicy(int source) {
  base::RunContext context = context_;
  context.progress = nullptr;
  context.deadline = std::min(context_.deadline, time_up_);
  StatusOr<api::ZeroPolicyReport> zero = flow_.ZeroPolicy(source, context);
  if (absl::IsCancelled(zero.status())) return zero.status();
  POISE_RETURN_IF_ERROR(context_.Check());
  std::lock_guard lock(mutex_);
  // A baseline that there is no time for, or that no simulation survives, is no error.
  if (zero.ok()) state_.zero_policies[source] = *std::move(zero);
  return Count(1);
}

Status CorrectRun::DoVariant(int64_t ordinal) {
  base::RunContext context = context_;
  context.progress = [&](const base::Progress& progress) { ShowRollout(ordinal, progress); };
  context.deadline = std::min(context_.deadline, ShareOfTime());
  POISE_ASSIGN_OR_RETURN(CorrectedVariant variant,
                         flow_.Correct(ordinal, context, std::min(context_.deadline, time_up_)));
  if (variant.timed_out) POISE_RETURN_IF_ERROR(context_.Check());
  if (config_.finish) POISE_RETURN_IF_ERROR(config_.finish(variant));
  std::lock_guard lock(mutex_);
  running_.erase(ordinal);
  state_.variants[ordinal] = std::move(variant);
  return Count(flow_.rollouts());
}

absl::Time CorrectRun::ShareOfTime() {
  std::lock_guard lock(mutex_);
  const int64_t rounds = (variants_waiting_ + threads_ - 1) / threads_;
  --variants_waiting_;
  if (time_up_ == absl::InfiniteFuture()) return time_up_;
  const absl::Time now = absl::Now();
  return now + (time_up_ - now) / std::max<int64_t>(rounds, 1);
}

void CorrectRun::ShowRollout(int64_t ordinal, const base::Progress& progress) {
  std::lock_guard lock(mutex_);
  running_[ordinal] = progress;
  ReportProgress();
}

Status CorrectRun::Count(int64_t steps) {
  step_ += steps;
  state_.seconds = seconds_before_ + absl::ToDoubleSeconds(absl::Now() - start_);
  ReportProgress();
  return config_.on_done ? config_.on_done(state_, step_) : absl::OkStatus();
}

void CorrectRun::ReportProgress() const {
  Tally tally;
  int64_t step = step_;
  double samples = 0;
  for (const auto& variant : state_.variants) {
    if (!variant) continue;
    samples += static_cast<double>(variant->samples);
    if (!variant->report.after) continue;
    const api::CorrectionScore& score = variant->report.after->score;
    tally.Add(score.reward_normalised, score.residual_force_mean_bw, score.residual_torque_mean_nm);
  }
  for (const auto& [ordinal, progress] : running_) {
    step += progress.step;
    samples += Metric(progress, "samples");
    tally.Add(Metric(progress, "reward"), Metric(progress, "force"), Metric(progress, "torque"));
  }
  base::Progress progress{.step = step, .total = total_, .message = "correcting"};
  progress.metrics["samples"] = samples;
  if (tally.count > 0) {
    progress.metrics["reward"] = tally.reward / tally.count;
    progress.metrics["force"] = tally.force / tally.count;
    progress.metrics["torque"] = tally.torque / tally.count;
  }
  if (step > first_step_) {
    const absl::Time now = absl::Now();
    const absl::Duration left = (now - start_) * (static_cast<double>(total_ - step) /
                                                  static_cast<double>(step - first_step_));
    progress.metrics["eta_s"] =
        std::max(0.0, absl::ToDoubleSeconds(std::min(left, time_up_ - now)));
  }
  context_.Report(progress);
}

api::CorrectedClipReport CorrectRun::Report(int source) const {
  api::CorrectedClipReport report;
  report.name = flow_.source_name(source);
  report.zero_policy = state_.zero_policies[source];
  report.stopped_by = "finished";
  std::vector<const CorrectedVariant*> variants;
  const int64_t first = int64_t{source} * flow_.variants_per_source();
  for (int64_t i = first; i < first + flow_.variants_per_source(); ++i) {
    const CorrectedVariant& variant = *state_.variants[i];
    report.samples += variant.samples;
    if (variant.timed_out) report.stopped_by = "max_seconds";
    report.variants.push_back(variant.report);
    variants.push_back(&variant);
  }
  report.reward_curve = MeanCurve(variants);
  return report;
}

}  // namespace poise::pipeline
