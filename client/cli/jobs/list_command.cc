#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>

#include "absl/time/clock.h"
#include "client/cli/interrupt.h"
#include "client/cli/jobs/commands.h"
#include "client/cli/jobs/job_json.h"
#include "client/cli/jobs/job_options.h"
#include "client/cli/jobs/job_text.h"
#include "client/cli/jobs/live_lines.h"
#include "client/client.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "List jobs, the newest first.\n\n"
    "With --watch the table is drawn anew every second until no job in it is unfinished; where "
    "there is no terminal, a line is printed for every job that has changed.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise jobs list\n"
    "  poise jobs list --state FAILED --label run=7\n"
    "  poise jobs list --filter \"state=RUNNING kind=selftest\" --json\n"
    "  poise jobs list --watch";

struct ListOptions {
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  std::string filter;
  std::string state, kind, queue;
  std::vector<std::string> labels;
  int limit = 50;
  bool watch = false;
  double interval_s = 1;
};

StatusOr<api::JobFilter> Filter(const ListOptions& options) {
  POISE_ASSIGN_OR_RETURN(api::JobFilter filter, api::JobFilter::Parse(options.filter));
  if (!options.state.empty()) {
    POISE_ASSIGN_OR_RETURN(filter.state, api::ParseJobState(options.state));
  }
  if (!options.kind.empty()) filter.kind = options.kind;
  if (!options.queue.empty()) filter.queue = options.queue;
  POISE_ASSIGN_OR_RETURN(const auto labels, ParsePairs(options.labels, "label"));
  for (const auto& [key, value] : labels) filter.labels[key] = value;
  return filter;
}

struct Listing {
  std::vector<api::Job> jobs;
  bool more = false;
};

StatusOr<Listing> Fetch(client::Client& client, const api::JobFilter& filter, int limit) {
  Listing listing;
  std::string token;
  while (static_cast<int>(listing.jobs.size()) < limit) {
    const int missing = limit - static_cast<int>(listing.jobs.size());
    POISE_ASSIGN_OR_RETURN(api::JobPage page, client.ListJobs(filter, missing, token));
    std::move(page.jobs.begin(), page.jobs.end(), std::back_inserter(listing.jobs));
    token = page.next_page_token;
    if (token.empty()) break;
  }
  listing.more = !token.empty();
  return listing;
}

void Print(const Listing& listing, const ListOptions& options, const Console& console) {
  if (console.json()) {
    for (const api::Job& job : listing.jobs) console.PrintJson(JobJson(job));
    return;
  }
  if (listing.jobs.empty()) return console.Note("no jobs");
  console.Print(JobTable(listing.jobs, absl::Now()));
  if (listing.more) {
    console.Note(fmt::format("there are more than {}: see --limit and --state", options.limit));
  }
}

/// Looks again and again, and shows what has changed.
class ListWatch {
 public:
  ListWatch(const ListOptions& options, const Console& console)
      : options_(options), console_(console), interrupt_([this] { Stop(); }) {}

  Status Run(const api::JobFilter& filter) {
    POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options_.connection));
    std::unique_ptr<LiveLines> live;
    if (!console_.json() && Console::HasTerminal()) live = std::make_unique<LiveLines>();
    while (true) {
      POISE_ASSIGN_OR_RETURN(const Listing listing, Fetch(*client, filter, options_.limit));
      const bool done = std::all_of(listing.jobs.begin(), listing.jobs.end(),
                                    [](const api::Job& job) { return api::IsTerminal(job.state); });
      if (live != nullptr) {
        live->Show(listing.jobs.empty() ? "no jobs" : JobTable(listing.jobs, absl::Now()), true);
      } else {
        PrintChanges(listing);
      }
      if (done || !WaitForNextLook()) {
        live.reset();
        if (!console_.json() && Console::HasTerminal()) Print(listing, options_, console_);
        break;
      }
    }
    if (!interrupt_.interrupted()) return absl::OkStatus();
    return base::MakeError(absl::StatusCode::kCancelled, "INTERRUPTED", "",
                           "stopped watching; the jobs run on");
  }

 private:
  void PrintChanges(const Listing& listing) {
    for (const api::Job& job : listing.jobs) {
      const bool changed = std::exchange(seen_[job.id], job.event_seq) != job.event_seq;
      if (!changed) continue;
      if (console_.json()) {
        console_.PrintJson(JobJson(job));
      } else {
        console_.Print(JobLine(job));
      }
    }
  }

  bool WaitForNextLook() {
    std::unique_lock lock(mutex_);
    stopped_changed_.wait_for(lock, std::chrono::duration<double>(options_.interval_s),
                              [this] { return stopped_; });
    return !stopped_;
  }

  void Stop() {
    std::lock_guard lock(mutex_);
    stopped_ = true;
    stopped_changed_.notify_all();
  }

  const ListOptions& options_;
  const Console& console_;
  std::map<std::string, int64_t> seen_;  // event number by id
  std::mutex mutex_;
  std::condition_variable stopped_changed_;
  bool stopped_ = false;
  InterruptHandler interrupt_;
};

Status RunList(const ListOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const api::JobFilter filter, Filter(options));
  if (options.watch) return ListWatch(options, console).Run(filter);
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const Listing listing, Fetch(*client, filter, options.limit));
  Print(listing, options, console);
  return absl::OkStatus();
}

}  // namespace

Command AddJobsListCommand(CLI::App& jobs, const Console& console) {
  auto options = std::make_shared<ListOptions>();
  CLI::App* command = jobs.add_subcommand("list", kDescription);
  command->footer(kFooter);
  command
      ->add_option("--state", options->state,
                   "QUEUED, RUNNING, CANCELLING, SUCCEEDED, FAILED or CANCELLED")
      ->type_name("STATE");
  command->add_option("--kind", options->kind, "Of this kind only")->type_name("KIND");
  command->add_option("--queue", options->queue, "In this queue only")->type_name("NAME");
  command->add_option("--label", options->labels, "With this label; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command
      ->add_option("--filter", options->filter,
                   "The same as one text: \"state=FAILED kind=selftest label.run=7\"")
      ->type_name("TERMS");
  command->add_option("--limit", options->limit, "At most this many")
      ->type_name("N")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  command->add_flag("--watch", options->watch, "Stay, and show what changes");
  command->add_option("--interval", options->interval_s, "With --watch: time between two looks")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  AddConnectionFlags(*command, options->connection);
  return {command, [options, &console] { return RunList(*options, console); }};
}

}  // namespace poise::cli
