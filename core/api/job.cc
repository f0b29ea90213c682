#include "core/api/job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>

namespace poise::api {
namespace {

constexpr std::array kStates = {JobState::kQueued,    JobState::kRunning, JobState::kCancelling,
                                JobState::kSucceeded, JobState::kFailed,  JobState::kCancelled};
constexpr size_t kMaxNameLength = 63;
constexpr size_t kMaxLabelLength = 256;
constexpr int kMaxPriority = 10;
constexpr int kMaxBudget = 1000;

// Letters, digits, '-', '_' and '.': safe in filters, metrics and log lines.
bool IsName(std::string_view text) {
  return !text.empty() && text.size() <= kMaxNameLength &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
         });
}

// What can stand in a filter as it is.
bool IsLabelValue(std::string_view text) {
  return text.size() <= kMaxLabelLength &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return c > ' ' && c < 127; });
}

Status CheckBudget(int value, const char* field) {
  if (value >= 1 && value <= kMaxBudget) return absl::OkStatus();
  return base::InvalidArgument("BAD_LIMIT", field,
                               fmt::format("{} is {}, expected 1 to {}", field, value, kMaxBudget));
}

Status CheckDuration(absl::Duration value, const char* field) {
  if (value > absl::ZeroDuration()) return absl::OkStatus();
  return base::InvalidArgument(
      "BAD_LIMIT", field,
      fmt::format("{} is {}, expected more than 0", field, absl::FormatDuration(value)));
}

Status CheckLabels(const std::map<std::string, std::string>& labels) {
  if (labels.size() > CreateJob::kMaxLabels) {
    return base::InvalidArgument("TOO_MANY_LABELS", "labels",
                                 fmt::format("{} labels, at most {}", labels.size(),
                                             static_cast<int>(CreateJob::kMaxLabels)));
  }
  for (const auto& [key, value] : labels) {
    if (IsName(key) && IsLabelValue(value)) continue;
    return base::InvalidArgument(
        "BAD_LABEL", "labels",
        fmt::format(
            "label '{}': expected a key of at most {} letters, digits, '-', '_' or '.', and "
            "a value of at most {} visible characters",
            key, kMaxNameLength, kMaxLabelLength));
  }
  return absl::OkStatus();
}

}  // namespace

const char* JobStateName(JobState state) {
  switch (state) {
    case JobState::kQueued:
      return "QUEUED";
    case JobState::kRunning:
      return "RUNNING";
    case JobState::kCancelling:
      return "CANCELLING";
    case JobState::kSucceeded:
      return "SUCCEEDED";
    case JobState::kFailed:
      return "FAILED";
    case JobState::kCancelled:
      return "CANCELLED";
  }
  return "UNKNOWN";
}

StatusOr<JobState> ParseJobState(std::string_view name) {
  for (const JobState state : kStates) {
    if (name == JobStateName(state)) return state;
  }
  return base::InvalidArgument(
      "UNKNOWN_JOB_STATE", "state",
      fmt::format("'{}' is no state of a job, expected QUEUED, RUNNING, CANCELLING, SUCCEEDED, "
                  "FAILED or CANCELLED",
                  name));
}

bool IsTerminal(JobState state) {
  return state == JobState::kSucceeded || state == JobState::kFailed ||
         state == JobState::kCancelled;
}

const char* AttemptOutcomeName(AttemptOutcome outcome) {
  switch (outcome) {
    case AttemptOutcome::kRunning:
      return "RUNNING";
    case AttemptOutcome::kSucceeded:
      return "SUCCEEDED";
    case AttemptOutcome::kError:
      return "ERROR";
    case AttemptOutcome::kLost:
      return "LOST";
    case AttemptOutcome::kStalled:
      return "STALLED";
    case AttemptOutcome::kReleased:
      return "RELEASED";
    case AttemptOutcome::kCancelled:
      return "CANCELLED";
  }
  return "UNKNOWN";
}

JobError JobError::From(const Status& status) {
  return {.code = status.code(),
          .reason = base::ErrorReason(status),
          .message = base::Message(status),
          .field = base::ErrorField(status)};
}

Status JobError::ToStatus() const { return base::MakeError(code, reason, field, message); }

Status JobLimits::Validate() const {
  POISE_RETURN_IF_ERROR(CheckBudget(max_errors, "limits.max_errors"));
  POISE_RETURN_IF_ERROR(CheckBudget(max_losses, "limits.max_losses"));
  POISE_RETURN_IF_ERROR(CheckDuration(deadline, "limits.deadline"));
  POISE_RETURN_IF_ERROR(CheckDuration(stall_timeout, "limits.stall_timeout"));
  return CheckDuration(cancel_grace, "limits.cancel_grace");
}

Status CreateJob::Validate() const {
  if (request_id.size() > kMaxRequestIdLength || !IsLabelValue(request_id)) {
    return base::InvalidArgument(
        "BAD_REQUEST_ID", "request_id",
        fmt::format("expected at most {} visible ASCII characters", kMaxRequestIdLength));
  }
  if (!IsName(queue)) {
    return base::InvalidArgument(
        "BAD_QUEUE", "queue",
        fmt::format("queue '{}': expected 1 to {} letters, digits, '-', '_' or '.'", queue,
                    kMaxNameLength));
  }
  if (priority < -kMaxPriority || priority > kMaxPriority) {
    return base::InvalidArgument(
        "BAD_PRIORITY", "priority",
        fmt::format("priority is {}, expected -{} to {}", priority, kMaxPriority, kMaxPriority));
  }
  if (const size_t bytes = spec.parameters.dump().size(); bytes > kMaxParametersBytes) {
    return base::InvalidArgument(
        "TOO_LARGE", "spec.parameters",
        fmt::format("the parameters have {} bytes, at most {}: upload large input as an artifact",
                    bytes, kMaxParametersBytes));
  }
  POISE_RETURN_IF_ERROR(CheckLabels(labels));
  return limits.Validate();
}

StatusOr<JobFilter> JobFilter::Parse(std::string_view text) {
  constexpr std::string_view kLabelPrefix = "label.";
  JobFilter filter;
  std::istringstream terms{std::string(text)};
  for (std::string term; terms >> term;) {
    const size_t equals = term.find('=');
    const std::string key = term.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : term.substr(equals + 1);
    if (key == "state" && !value.empty()) {
      POISE_ASSIGN_OR_RETURN(filter.state, ParseJobState(value));
    } else if (key == "kind" && IsName(value)) {
      filter.kind = value;
    } else if (key == "queue" && IsName(value)) {
      filter.queue = value;
    } else if (key.starts_with(kLabelPrefix) && IsName(key.substr(kLabelPrefix.size()))) {
      filter.labels[key.substr(kLabelPrefix.size())] = value;
    } else {
      return base::InvalidArgument(
          "BAD_FILTER", "filter",
          fmt::format("'{}': expected terms like state=FAILED kind=selftest queue=default "
                      "label.run=7, joined by spaces",
                      term));
    }
  }
  return filter;
}

std::string JobFilter::ToString() const {
  std::string text;
  const auto add = [&text](std::string_view key, std::string_view value) {
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", key, value);
  };
  if (state) add("state", JobStateName(*state));
  if (!kind.empty()) add("kind", kind);
  if (!queue.empty()) add("queue", queue);
  for (const auto& [key, value] : labels) add("label." + key, value);
  return text;
}

}  // namespace poise::api
