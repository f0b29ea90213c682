#include "client/cli/jobs/job_follower.h"

#include <fmt/format.h>

#include <thread>

#include "client/cli/jobs/job_json.h"
#include "client/cli/jobs/job_text.h"
#include "proto/convert/job_convert.h"

namespace poise::cli {

JobFollower::JobFollower(const Console& console, Style style)
    : console_(console), style_(style), interrupt_([this] { Stop(); }) {}

Status JobFollower::Follow(client::Client& client, const std::vector<std::string>& ids,
                           absl::Time deadline) {
  {
    std::lock_guard lock(mutex_);
    if (!console_.json() && Console::HasTerminal()) live_ = std::make_unique<LiveLines>();
    jobs_.clear();
    for (const std::string& id : ids) {
      jobs_.push_back({.id = id,
                       .watch = client.WatchJob(id, {.after_seq = 0, .deadline = deadline}),
                       .job = {},
                       .status = {}});
      jobs_.back().job.id = id;
      if (stopped_) jobs_.back().watch->Cancel();
    }
  }
  std::vector<std::thread> threads;
  for (Followed& followed : jobs_) threads.emplace_back([this, &followed] { Run(followed); });
  for (std::thread& thread : threads) thread.join();
  live_.reset();
  if (interrupt_.interrupted()) {
    std::vector<std::string> names;
    for (const std::string& id : ids) names.push_back(convert::JobName(id));
    return base::MakeError(
        absl::StatusCode::kCancelled, "INTERRUPTED", "",
        fmt::format("stopped watching; what is not done runs on. To end it: poise jobs cancel {}",
                    fmt::join(names, " ")));
  }
  for (const Followed& followed : jobs_) POISE_RETURN_IF_ERROR(followed.status);
  return absl::OkStatus();
}

void JobFollower::Run(Followed& followed) {
  while (true) {
    const auto event = followed.watch->Next();
    std::lock_guard lock(mutex_);
    followed.status = event.status();
    if (!event.ok() || !event->has_value()) break;
    followed.job = followed.watch->job();
    Show(followed, **event);
  }
}

void JobFollower::Show(Followed& followed, const api::JobEvent& event) {
  if (live_ != nullptr) {
    live_->Show(Text(), event.state && api::IsTerminal(*event.state));
  } else if (style_ == Style::kEvents && console_.json()) {
    console_.PrintJson(EventJson(followed.id, event));
  } else if (!console_.json()) {
    PrintChange(followed, event);
  }
}

// With --json nothing; otherwise on standard output when it is what was asked for.
void JobFollower::PrintChange(Followed& followed, const api::JobEvent& event) {
  api::Job shown;
  shown.id = followed.id;
  shown.attempt = event.attempt;
  if (event.state) {
    shown.state = *event.state;
    shown.error = event.error;
    followed.tenth = 0;
  } else if (event.progress && event.progress->total > 0) {
    const int64_t tenth = event.progress->step * 10 / event.progress->total;
    if (tenth == followed.tenth) return;
    followed.tenth = tenth;
    shown.state = api::JobState::kRunning;
    shown.progress = *event.progress;
  } else {
    return;
  }
  if (style_ == Style::kEvents) {
    console_.Print(JobLine(shown));
  } else {
    console_.Note(JobLine(shown));
  }
}

std::string JobFollower::Text() const {
  std::vector<std::string> lines;
  for (const Followed& followed : jobs_) lines.push_back(JobLine(followed.job));
  return fmt::format("{}", fmt::join(lines, "\n"));
}

void JobFollower::Stop() {
  std::lock_guard lock(mutex_);
  stopped_ = true;
  for (Followed& followed : jobs_) followed.watch->Cancel();
}

Status JobOutcome(const api::Job& job) {
  if (job.state == api::JobState::kFailed) {
    const std::string why = job.error ? job.error->message : "no reason given";
    return base::MakeError(absl::StatusCode::kAborted, kJobFailedReason, "",
                           fmt::format("{} FAILED: {}", convert::JobName(job.id), why));
  }
  if (job.state == api::JobState::kCancelled) {
    return base::MakeError(absl::StatusCode::kCancelled, kJobCancelledReason, "",
                           fmt::format("{} was CANCELLED", convert::JobName(job.id)));
  }
  return absl::OkStatus();
}

}  // namespace poise::cli
