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
  state.policies.resize(flow.num_sources());
  state.zero_policies.resize(flow.num_sources());
  state.variants.resize(flow.num_variants());
  return state;
}

CorrectRun::CorrectRun(CorrectFlow& flow, CorrectRunConfig config, CorrectState state)
    : flow_(flow), config_(std::move(config)), state_(std::move(state)) {
  for (int source = 0; source < flow.num_sources(); ++source) {
    if (!state_.zero_policies[source]) units_.push_back({.is_variant = false, .index = source});
    const int64_t first = int64_t{source} * flow.variants_per_source();
    for (int64_t i = first; i < first + flow.variants_per_source(); ++i) {
      if (!state_.variants[i]) units_.push_back({.is_variant = true, .index = i});
    }
  }
  for (int source = 0; source < flow.num_sources(); ++source) {
    total_ += flow.max_training_samples() + flow.frames(source) +
              flow.variants_per_source() * flow.samples_per_variant(source);
  }
  step_ = total_;
  for (const Unit& unit : units_) step_ -= StepsOf(unit);
  for (const LearnedPolicy& policy : state_.policies) {
    if (!policy.finished) step_ -= flow.max_training_samples();
  }
  first_step_ = step_;
}

int64_t CorrectRun::StepsOf(const Unit& unit) const {
  if (!unit.is_variant) return flow_.frames(static_cast<int>(unit.index));
  return flow_.samples_per_variant(static_cast<int>(unit.index / flow_.variants_per_source()));
}

Status CorrectRun::Run(const base::RunContext& context) {
  context_ = context;
  start_ = absl::Now();
  seconds_before_ = state_.seconds;
  absl::Time end = absl::InfiniteFuture();
  if (config_.max_seconds > 0) end = start_ + absl::Seconds(config_.max_seconds - seconds_before_);
  threads_ = config_.threads > 0 ? config_.threads : base::AvailableCpus();
  {
    std::lock_guard lock(mutex_);
    ReportProgress();
  }
  const int sources = flow_.num_sources();
  if (!flow_.learns()) return RunSources(0, sources, end);
  for (int source = 0; source < sources; ++source) {
    const absl::Time now = absl::Now();
    const absl::Time time_up =
        end == absl::InfiniteFuture() ? end : now + (end - now) / (sources - source);
    POISE_RETURN_IF_ERROR(Learn(source));
    POISE_RETURN_IF_ERROR(RunSources(source, source + 1, time_up));
  }
  return absl::OkStatus();
}

Status CorrectRun::Learn(int source) {
  LearnedPolicy policy = state_.policies[source];
  base::RunContext context = context_;
  context.progress = [&](const base::Progress& progress) {
    std::lock_guard lock(mutex_);
    learning_ = progress;
    ReportProgress();
  };
  const auto save = [&](const LearnedPolicy& learned) {
    std::lock_guard lock(mutex_);
    state_.policies[source] = learned;
    if (learned.finished) learning_.reset();
    return Count(learned.finished ? flow_.max_training_samples() : 0);
  };
  return flow_.Learn(source, context, save, policy);
}

Status CorrectRun::RunSources(int first, int last, absl::Time time_up) {
  const auto is_before = [this](const Unit& unit, int source) {
    return (unit.is_variant ? unit.index / flow_.variants_per_source() : unit.index) < source;
  };
  const auto begin = std::lower_bound(units_.begin(), units_.end(), first, is_before);
  const auto end = std::lower_bound(begin, units_.end(), last, is_before);
  time_up_ = time_up;
  next_unit_ = static_cast<size_t>(begin - units_.begin());
  end_unit_ = static_cast<size_t>(end - units_.begin());
  variants_waiting_ = std::count_if(begin, end, [](const Unit& unit) { return unit.is_variant; });
  {
    const int most = std::max<int>(1, static_cast<int>(end - begin));
    base::ThreadPool pool(std::clamp(threads_, 1, most));
    for (int i = 0; i < pool.size(); ++i) pool.Submit([this] { Work(); });
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
  if (!status_.ok() || next_unit_ == end_unit_) return std::nullopt;
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
  return Count(flow_.frames(source));
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
  return Count(StepsOf({.is_variant = true, .index = ordinal}));
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
  Running& running = running_[ordinal];
  // Once after each rollout; a policy's corrections come to the motion twice.
  running.samples += flow_.frames(static_cast<int>(ordinal / flow_.variants_per_source()));
  running.progress = progress;
  ReportProgress();
}

Status CorrectRun::Count(int64_t steps) {
  step_ += steps;
  state_.seconds = seconds_before_ + absl::ToDoubleSeconds(absl::Now() - start_);
  ReportProgress();
  if (!config_.on_done) return absl::OkStatus();
  return config_.on_done(state_, step_ + (learning_ ? learning_->step : 0));
}

void CorrectRun::ReportProgress() const {
  Tally tally;
  int64_t step = step_;
  int64_t samples = 0;
  for (const LearnedPolicy& policy : state_.policies) samples += policy.samples;
  for (const auto& variant : state_.variants) {
    if (!variant) continue;
    samples += variant->samples;
    if (!variant->report.after) continue;
    const api::CorrectionScore& score = variant->report.after->score;
    tally.Add(score.reward_normalised, score.residual_force_mean_bw, score.residual_torque_mean_nm);
  }
  const auto add = [&](const base::Progress& progress, int64_t more) {
    step += more;
    samples += more;
    tally.Add(Metric(progress, "reward"), Metric(progress, "force"), Metric(progress, "torque"));
  };
  for (const auto& [ordinal, running] : running_) add(running.progress, running.samples);
  if (learning_) {
    tally = Tally();  // of its own variants, and of no others
    add(*learning_, learning_->step);
  }
  base::Progress progress{
      .step = step, .total = total_, .message = learning_ ? "learning" : "correcting"};
  progress.metrics["samples"] = static_cast<double>(samples);
  if (tally.count > 0) {
    progress.metrics["reward"] = tally.reward / tally.count;
    progress.metrics["force"] = tally.force / tally.count;
    progress.metrics["torque"] = tally.torque / tally.count;
  }
  if (learning_) {
    progress.metrics["eta_s"] = Metric(*learning_, "eta_s");
  } else if (step > first_step_) {
    const absl::Time now = absl::Now();
    const double rest =
        static_cast<double>(total_ - step) / static_cast<double>(step - first_step_);
    progress.metrics["eta_s"] =
        std::max(0.0, absl::ToDoubleSeconds(std::min((now - start_) * rest, time_up_ - now)));
  }
  context_.Report(progress);
}

api::CorrectedClipReport CorrectRun::Report(int source) const {
  api::CorrectedClipReport report;
  report.name = flow_.source_name(source);
  report.zero_policy = state_.zero_policies[source];
  const LearnedPolicy& policy = state_.policies[source];
  report.stopped_by = policy.finished ? policy.stopped_by : "finished";
  report.samples = policy.samples;
  std::vector<const CorrectedVariant*> variants;
  const int64_t first = int64_t{source} * flow_.variants_per_source();
  for (int64_t i = first; i < first + flow_.variants_per_source(); ++i) {
    const CorrectedVariant& variant = *state_.variants[i];
    report.samples += variant.samples;
    if (variant.timed_out) report.stopped_by = "max_seconds";
    report.variants.push_back(variant.report);
    variants.push_back(&variant);
  }
  report.reward_curve = policy.finished ? policy.curve : MeanCurve(variants);
  return report;
}

}  // namespace poise::pipeline
