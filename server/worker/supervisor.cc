#include "server/worker/supervisor.h"

#include <unistd.h>

#include <algorithm>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/identifier.h"
#include "server/log.h"
#include "server/worker/attempt.h"
#include "server/worker/persistence.h"
#include "server/worker/work_folder.h"

namespace poise::worker {
namespace {

using server::Log;
namespace level = server::level;

constexpr int kTokenBytes = 16;

}  // namespace

Supervisor::Supervisor(WorkerConfig config, base::Telemetry& telemetry,
                       std::function<void()> on_registered)
    : config_(std::move(config)),
      telemetry_(telemetry),
      on_registered_(std::move(on_registered)),
      client_(config_.client) {}

Status Supervisor::Run() {
  POISE_ASSIGN_OR_RETURN(const std::unique_ptr<WorkFolder> folder,
                         WorkFolder::Create(config_.work_dir, config_.info.id));
  const StatusOr<absl::Duration> heartbeat_interval = Register();
  if (drain_.stage() != DrainStage::kWork) return absl::OkStatus();
  POISE_RETURN_IF_ERROR(heartbeat_interval.status());
  on_registered_();
  std::vector<std::thread> slots;
  slots_ = config_.info.slots;
  for (int i = 0; i < config_.info.slots; ++i) {
    slots.emplace_back([&] { RunSlot(folder->path(), *heartbeat_interval); });
  }
  Watch();
  for (std::thread& slot : slots) slot.join();
  Log(level::info, "stopped");
  return absl::OkStatus();
}

void Supervisor::Stop() {
  const bool again = drain_.stage() != DrainStage::kWork;
  if (!again) return Drain("signal");
  Log(level::info, "hurrying");
  drain_.Advance(DrainStage::kHurry);
}

void Supervisor::Drain(const char* why) {
  {
    std::lock_guard lock(mutex_);
    if (drain_begin_) return;
    drain_begin_ = Clock::now();
  }
  Log(level::info, "draining", {{"why", why}});
  drain_.Advance(DrainStage::kDrain);
}

StatusOr<absl::Duration> Supervisor::Register() {
  return Persist(
      [this] {
        auto answer = client_.Register(config_.info);
        NoteServer(answer.status());
        return answer;
      },
      [this] { return drain_.stage() != DrainStage::kWork || IdleTime() >= config_.idle_exit; });
}

void Supervisor::NoteServer(const Status& status) {
  const bool lost = !IsDefinite(status) && drain_.stage() == DrainStage::kWork;
  if (server_lost_.exchange(lost) == lost) return;
  base::Json fields = {{"server", config_.client.server}};
  if (lost) fields["message"] = base::Message(status);
  Log(lost ? level::warn : level::info, lost ? "server_lost" : "server_found", fields);
}

void Supervisor::RunSlot(const std::filesystem::path& folder, absl::Duration heartbeat_interval) {
  const AttemptSetting setting{.config = config_,
                               .folder = folder,
                               .heartbeat_interval = heartbeat_interval,
                               .client = client_,
                               .drain = drain_,
                               .telemetry = telemetry_};
  Pauses pauses;
  while (drain_.stage() == DrainStage::kWork) {
    const jobs::ClaimQuery query{.worker = config_.info.id,
                                 .token = base::RandomHex(kTokenBytes),
                                 .queues = config_.queues,
                                 .kinds = config_.kinds};
    const StatusOr<LeaseAnswer> answer = LeaseJob(query);
    if (answer.ok() && answer->lease) {
      pauses.Reset();
      {
        std::lock_guard lock(mutex_);
        ++busy_;
      }
      Attempt(setting, *answer->lease).Run();
      std::lock_guard lock(mutex_);
      --busy_;
      idle_since_ = Clock::now();
    } else if (base::ErrorReason(answer.status()) == "UNKNOWN_WORKER") {
      Register().IgnoreError();
    } else if (!answer.ok() || answer->draining) {
      if (!answer.ok() && drain_.stage() == DrainStage::kWork && IsDefinite(answer.status())) {
        Log(level::err, "lease_refused", {{"message", base::Message(answer.status())}});
      }
      drain_.WaitFor(pauses.Next());
    }
  }
  std::lock_guard lock(mutex_);
  --slots_;
  changed_.notify_all();
}

StatusOr<LeaseAnswer> Supervisor::LeaseJob(const jobs::ClaimQuery& query) {
  CallBreaker breaker;
  const DrainSignal::Listener listener(drain_, [&breaker] { breaker.Break(); });
  const absl::Duration wait =
      std::clamp(config_.idle_exit - IdleTime(), absl::Milliseconds(100), config_.lease_wait);
  // The token stays: when an answer was lost, the next one holds the same lease.
  StatusOr<LeaseAnswer> answer = Persist(
      [&] {
        auto once = client_.LeaseJob(query, wait, breaker);
        NoteServer(once.status());
        return once;
      },
      [this] { return drain_.stage() != DrainStage::kWork; });
  if (!answer.ok() && breaker.broken()) GiveBack(query);
  return answer;
}

void Supervisor::GiveBack(const jobs::ClaimQuery& query) {
  CallBreaker breaker;
  const StatusOr<LeaseAnswer> answer = client_.LeaseJob(query, absl::ZeroDuration(), breaker);
  if (!answer.ok() || !answer->lease) return;
  const Status status = Persist([&] { return client_.Release(answer->lease->fence, {}); },
                                [this] { return drain_.stage() == DrainStage::kHurry; });
  Log(level::info, status.ok() ? "released" : "release_not_taken",
      {{"job", answer->lease->fence.job}, {"attempt", answer->lease->fence.attempt}});
}

absl::Duration Supervisor::IdleTime() const {
  std::lock_guard lock(mutex_);
  return busy_ > 0 ? absl::ZeroDuration() : absl::FromChrono(Clock::now() - idle_since_);
}

void Supervisor::Watch() {
  constexpr std::chrono::milliseconds kLook{100};
  const auto since = [](Clock::time_point time) { return absl::FromChrono(Clock::now() - time); };
  std::optional<Clock::time_point> hurry_begin;
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, kLook, [this] { return slots_ == 0; })) {
    const bool drain_over = drain_begin_ && since(*drain_begin_) >= config_.drain;
    lock.unlock();
    if (IdleTime() >= config_.idle_exit) Drain("idle");
    if (since(start_) >= config_.max_time) Drain("max_time");
    if (drain_over) drain_.Advance(DrainStage::kHurry);
    if (!hurry_begin && drain_.stage() == DrainStage::kHurry) hurry_begin = Clock::now();
    if (hurry_begin && since(*hurry_begin) >= config_.hurry) {
      // Something does not end: the children die with this process.
      Log(level::err, "drain_budget_over");
      _exit(0);
    }
    lock.lock();
  }
}

}  // namespace poise::worker
