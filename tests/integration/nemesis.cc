#include "tests/integration/nemesis.h"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>

#include "absl/time/clock.h"
#include "tests/support/process_inspection.h"

namespace poise::testing {

std::string Harm::ToString() const {
  return fmt::format(
      "{} kills ({} children, {} supervisors, {} servers), {} pauses ({} children, {} "
      "supervisors)",
      kills(), children_killed, supervisors_killed, servers_killed, pauses(), children_paused,
      supervisors_paused);
}

Nemesis::Nemesis(JobCluster& cluster, std::vector<std::string> worker_flags, absl::Duration pause,
                 uint64_t seed)
    : cluster_(cluster), worker_flags_(std::move(worker_flags)), pause_(pause), random_(seed) {
  for (size_t i = 0; i < cluster_.num_workers(); ++i) workers_.push_back(i);
}

Nemesis::~Nemesis() { Wake(absl::InfiniteFuture()); }

void Nemesis::Act() {
  Wake(absl::Now());
  const size_t place = RandomWorker();
  const size_t worker = workers_[place];
  const int dice = std::uniform_int_distribution<int>(0, 99)(random_);
  if (dice < 6) {
    cluster_.StopServer(SIGKILL);
    cluster_.StartServer();
    ++harm_.servers_killed;
  } else if (dice < 30) {
    cluster_.worker(worker).Signal(SIGKILL);
    cluster_.worker(worker).Wait();
    workers_[place] = cluster_.StartWorker(worker_flags_);
    ++harm_.supervisors_killed;
  } else if (dice < 65) {
    const pid_t child = RandomChild(worker);
    if (child == 0 || kill(child, SIGKILL) != 0) return;
    ++harm_.children_killed;
  } else if (dice < 83) {
    Pause(cluster_.worker(worker).pid());
    ++harm_.supervisors_paused;
  } else {
    const pid_t child = RandomChild(worker);
    if (child == 0) return;
    Pause(child);
    ++harm_.children_paused;
  }
}

void Nemesis::Rest() {
  while (!paused_.empty()) {
    absl::SleepFor(absl::Milliseconds(50));
    Wake(absl::Now());
  }
}

void Nemesis::Wake(absl::Time now) {
  std::erase_if(paused_, [now](const Paused& paused) {
    if (paused.until > now) return false;
    kill(paused.pid, SIGCONT);
    return true;
  });
}

bool Nemesis::IsPaused(pid_t pid) const {
  return std::any_of(paused_.begin(), paused_.end(),
                     [pid](const Paused& paused) { return paused.pid == pid; });
}

void Nemesis::Pause(pid_t pid) {
  kill(pid, SIGSTOP);
  paused_.push_back({pid, absl::Now() + pause_});
}

size_t Nemesis::RandomWorker() {
  for (;;) {
    const size_t place = std::uniform_int_distribution<size_t>(0, workers_.size() - 1)(random_);
    if (!IsPaused(cluster_.worker(workers_[place]).pid())) return place;
    absl::SleepFor(absl::Milliseconds(20));
    Wake(absl::Now());
  }
}

pid_t Nemesis::RandomChild(size_t worker) {
  std::vector<pid_t> children = LivingChildrenOf(cluster_.worker(worker).pid());
  std::erase_if(children, [this](pid_t child) { return IsPaused(child); });
  if (children.empty()) return 0;
  return children[std::uniform_int_distribution<size_t>(0, children.size() - 1)(random_)];
}

}  // namespace poise::testing
