#include "client/cli/jobs/job_wait.h"

#include "client/cli/jobs/job_json.h"
#include "client/cli/jobs/job_options.h"
#include "client/cli/jobs/job_text.h"
#include "proto/convert/job_convert.h"

namespace poise::cli {

void AddWaitFlags(CLI::App& command, WaitFlags& flags) {
  command.add_flag("--wait", flags.wait, "Stay until the job has ended");
  command.add_option("--timeout", flags.timeout_s, "With --wait: give up after this long")
      ->type_name("SECONDS");
}

JobWait::JobWait(const WaitFlags& flags, const Console& console)
    : console_(console), deadline_(DeadlineAfter(flags.timeout_s)) {
  if (flags.wait) follower_.emplace(console, JobFollower::Style::kQuiet);
}

StatusOr<api::Job> JobWait::End(client::Client& client, api::Job job) {
  if (!follower_) return job;
  POISE_RETURN_IF_ERROR(follower_->Follow(client, {job.id}, deadline_));
  return client.GetJob(job.id);
}

Status JobWait::Answer(client::Client& client, api::Job job) {
  if (follower_) console_.Note(convert::JobName(job.id));
  POISE_ASSIGN_OR_RETURN(job, End(client, std::move(job)));
  return Report(job);
}

Status JobWait::Report(const api::Job& job) const {
  if (console_.json()) {
    console_.PrintJson(JobJson(job));
  } else {
    console_.Print(follower_ ? JobLine(job) : convert::JobName(job.id));
  }
  return follower_ ? JobOutcome(job) : absl::OkStatus();
}

}  // namespace poise::cli
