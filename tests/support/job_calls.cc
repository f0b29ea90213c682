#include "tests/support/job_calls.h"

#include <fmt/format.h>

#include "proto/convert/job_convert.h"

namespace poise::testing {
namespace {

StatusOr<api::Job> FromWire(const StatusOr<v1::Job>& job) {
  POISE_RETURN_IF_ERROR(job.status());
  return convert::FromProto(*job);
}

}  // namespace

api::CreateJob Selftest(const base::Json& parameters, uint64_t seed,
                        const std::string& request_id) {
  api::CreateJob request;
  request.spec = {.kind = "selftest", .parameters = parameters};
  request.seed = seed;
  request.request_id = request_id;
  return request;
}

StatusOr<api::Job> JobCalls::Create(const api::CreateJob& request) const {
  return FromWire(client_.Create(convert::ToProto(request)));
}

StatusOr<api::Job> JobCalls::Get(const std::string& id) const {
  return FromWire(client_.Get(convert::JobName(id)));
}

StatusOr<api::Job> JobCalls::Cancel(const std::string& id) const {
  return FromWire(client_.Cancel(convert::JobName(id)));
}

StatusOr<std::vector<api::Job>> JobCalls::List(const std::string& filter) const {
  std::vector<api::Job> jobs;
  v1::ListJobsRequest request;
  request.set_filter(filter);
  request.set_page_size(1000);
  do {
    POISE_ASSIGN_OR_RETURN(const v1::ListJobsResponse page, client_.List(request));
    for (const v1::Job& message : page.jobs()) {
      POISE_ASSIGN_OR_RETURN(api::Job job, convert::FromProto(message));
      jobs.push_back(std::move(job));
    }
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty());
  return jobs;
}

StatusOr<std::vector<api::JobEvent>> JobCalls::Events(const std::string& id) const {
  std::vector<api::JobEvent> events;
  Status bad = absl::OkStatus();
  const auto keep = [&](const v1::WatchJobResponse& response) {
    if (!response.has_event()) return;
    StatusOr<api::JobEvent> event = convert::FromProto(response.event());
    bad.Update(event.status());
    if (event.ok()) events.push_back(*std::move(event));
  };
  POISE_RETURN_IF_ERROR(client_.Watch(convert::JobName(id), 0, keep));
  POISE_RETURN_IF_ERROR(bad);
  return events;
}

api::Job WaitForJob(const JobCalls& calls, const std::string& id,
                    const std::function<bool(const api::Job&)>& condition, absl::Duration timeout) {
  const absl::Time deadline = absl::Now() + timeout;
  api::Job last;
  for (;;) {
    if (auto job = calls.Get(id); job.ok()) last = *std::move(job);
    if (condition(last) || absl::Now() > deadline) return last;
    absl::SleepFor(absl::Milliseconds(50));
  }
}

api::Job WaitForEnd(const JobCalls& calls, const std::string& id, absl::Duration timeout) {
  return WaitForJob(
      calls, id, [](const api::Job& job) { return api::IsTerminal(job.state); }, timeout);
}

std::string FaultOfHistory(const api::Job& job, const std::vector<api::JobEvent>& events) {
  int64_t seq = 0;
  int64_t change = 0;
  int terminal = 0;
  int runs = 0;
  for (const api::JobEvent& event : events) {
    if (event.seq <= seq) return fmt::format("event {} comes after {}", event.seq, seq);
    seq = event.seq;
    const int64_t expected = event.progress ? change : change + 1;
    if (event.change != expected) {
      return fmt::format("event {} is change {}, expected {}", seq, event.change, expected);
    }
    change = event.change;
    if (terminal > 0) return fmt::format("event {} follows the terminal one", seq);
    if (!event.state) continue;
    if (api::IsTerminal(*event.state)) {
      ++terminal;
      if (*event.state != job.state) return "the terminal event differs from the job's state";
    }
    if (*event.state == api::JobState::kRunning) ++runs;
  }
  if (terminal != 1) return fmt::format("{} terminal events", terminal);
  if (runs != job.attempt) return fmt::format("{} runs, but attempt {}", runs, job.attempt);
  if (job.attempts.size() != static_cast<size_t>(job.attempt)) {
    return fmt::format("{} attempts kept of {}", job.attempts.size(), job.attempt);
  }
  int succeeded = 0;
  for (const api::JobAttempt& attempt : job.attempts) {
    if (attempt.outcome == api::AttemptOutcome::kRunning) return "an attempt still runs";
    if (attempt.outcome == api::AttemptOutcome::kSucceeded) ++succeeded;
  }
  if (succeeded != (job.state == api::JobState::kSucceeded ? 1 : 0)) {
    return fmt::format("{} attempts succeeded of a job that {}", succeeded,
                       api::JobStateName(job.state));
  }
  return "";
}

}  // namespace poise::testing
