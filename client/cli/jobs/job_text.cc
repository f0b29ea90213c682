#include "client/cli/jobs/job_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "client/cli/table.h"
#include "proto/convert/job_convert.h"

namespace poise::cli {
namespace {

constexpr int kBarWidth = 20;

std::string TimeText(absl::Time time) {
  return std::string(absl::FormatTime("%Y-%m-%d %H:%M:%S", time, absl::LocalTimeZone()));
}

std::string ErrorText(const api::JobError& error) {
  return fmt::format("{} ({})", error.message, error.reason);
}

// A QUEUED job that has run before waits for its next attempt.
std::string StateText(const api::Job& job) {
  const bool waits = job.state == api::JobState::kQueued && job.attempt > 0;
  return waits ? "QUEUED again" : api::JobStateName(job.state);
}

std::string AttemptsText(const api::Job& job) {
  Table table({"attempt", "outcome", "worker", "ran", "CPU s", "steps", "why"});
  for (const api::JobAttempt& attempt : job.attempts) {
    const bool runs = attempt.end == absl::InfiniteFuture();
    table.AddRow({std::to_string(attempt.attempt), api::AttemptOutcomeName(attempt.outcome),
                  attempt.worker, runs ? "" : DurationText(attempt.end - attempt.start),
                  fmt::format("{:.1f}", attempt.usage.cpu_seconds),
                  fmt::format("{} to {}", attempt.from_step, attempt.last_step),
                  attempt.error ? ErrorText(*attempt.error) : ""});
  }
  return table.Text();
}

}  // namespace

std::string ProgressText(const base::Progress& progress) {
  std::string text;
  if (progress.total > 0) {
    const int64_t step = std::clamp<int64_t>(progress.step, 0, progress.total);
    const int filled = static_cast<int>(kBarWidth * static_cast<double>(step) /
                                        static_cast<double>(progress.total));
    text = fmt::format("[{}{}]  {}/{}", std::string(filled, '#'),
                       std::string(kBarWidth - filled, '.'), progress.step, progress.total);
  } else if (progress.step > 0) {
    text = fmt::format("step {}", progress.step);
  }
  const auto metric = [&](const char* name) {
    const auto found = progress.metrics.find(name);
    return found == progress.metrics.end() ? std::optional<double>() : found->second;
  };
  if (const auto reward = metric("reward")) text += fmt::format("  reward {:.3g}", *reward);
  // A reward says nothing without what held the body up.
  if (const auto force = metric("force")) text += fmt::format(", force {:.3f} BW", *force);
  if (const auto torque = metric("torque")) text += fmt::format(", torque {:.1f} N m", *torque);
  if (const auto left = metric("eta_s"); left && *left >= 0 && *left < 1e8) {
    const int64_t seconds = static_cast<int64_t>(*left + 0.5);
    text += fmt::format("  {}:{:02} left", seconds / 60, seconds % 60);
  }
  return text;
}

std::string DurationText(absl::Duration duration) {
  const double seconds = absl::ToDoubleSeconds(duration);
  if (seconds < 9.95) return fmt::format("{:.1f} s", std::max(seconds, 0.0));
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  if (seconds < 48 * 3600) return fmt::format("{:.0f} h", seconds / 3600);
  return fmt::format("{:.0f} d", seconds / 86400);
}

std::string JobLine(const api::Job& job) {
  std::string line = fmt::format("{}  {}", convert::JobName(job.id), StateText(job));
  const std::string progress = ProgressText(job.progress);
  if (!progress.empty()) line += "  " + progress;
  if (job.attempt > 1) line += fmt::format("  attempt {}", job.attempt);
  if (job.error) line += "  " + ErrorText(*job.error);
  return line;
}

std::string JobTable(const std::vector<api::Job>& jobs, absl::Time now) {
  Table table({"job", "kind", "state", "progress", "attempt", "errors", "losses", "age"});
  for (const api::Job& job : jobs) {
    table.AddRow({convert::JobName(job.id), job.spec.kind, api::JobStateName(job.state),
                  ProgressText(job.progress), std::to_string(job.attempt),
                  std::to_string(job.errors), std::to_string(job.losses),
                  DurationText(now - job.create_time)});
  }
  return table.Text();
}

std::string JobDetails(const api::Job& job) {
  std::vector<std::pair<std::string, std::string>> rows = {
      {"kind", job.spec.kind},
      {"state", StateText(job)},
      {"progress", ProgressText(job.progress)},
      {"error", job.error ? ErrorText(*job.error) : ""},
      {"parameters", job.spec.parameters.empty() ? "" : job.spec.parameters.dump()},
      {"attempt", fmt::format("{}; {} of {} errors, {} of {} losses", job.attempt, job.errors,
                              job.limits.max_errors, job.losses, job.limits.max_losses)},
      {"queue", fmt::format("{}, priority {}, seed {}", job.queue, job.priority, job.seed)},
      {"created", TimeText(job.create_time)}};
  if (job.end_time < absl::InfiniteFuture()) {
    rows.emplace_back("ended", fmt::format("{}, {} after its creation", TimeText(job.end_time),
                                           DurationText(job.end_time - job.create_time)));
  } else if (job.next_attempt_time < absl::InfiniteFuture()) {
    rows.emplace_back("next attempt", "not before " + TimeText(job.next_attempt_time));
  }
  if (job.checkpoint) rows.emplace_back("checkpoint", fmt::format("step {}", job.checkpoint->step));
  for (const auto& [key, value] : job.labels) rows.emplace_back("label", key + "=" + value);
  for (const api::JobArtifact& file : job.artifacts) {
    rows.emplace_back("result", fmt::format("{}, {} bytes", file.name, file.size_bytes));
  }
  if (!job.retry_of.empty()) rows.emplace_back("retry of", convert::JobName(job.retry_of));
  rows.emplace_back("request id", job.request_id);
  std::string text = convert::JobName(job.id);
  for (const auto& [name, value] : rows) {
    if (!value.empty()) text += fmt::format("\n  {:<12}  {}", name, value);
  }
  return job.attempts.empty() ? text : text + "\n\n" + AttemptsText(job);
}

}  // namespace poise::cli
