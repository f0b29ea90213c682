#include "core/engine/job_maintenance.h"

#include <algorithm>
#include <utility>

#include "absl/time/clock.h"

namespace poise::engine {
namespace {

constexpr absl::Duration kComplaintInterval = absl::Seconds(1);
constexpr double kJitter = 0.25;

}  // namespace

JobMaintenance::JobMaintenance(JobLog& log)
    : log_(log), random_(static_cast<uint64_t>(absl::ToUnixNanos(absl::Now()))) {}

void JobMaintenance::Start(std::vector<RepeatedTask> tasks) {
  for (RepeatedTask& task : tasks) {
    const absl::Time first = absl::Now() + task.delay;
    repeated_.push_back({std::move(task), first});
  }
  thread_ = std::thread([this] { Loop(); });
}

void JobMaintenance::Stop() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void JobMaintenance::RunAt(absl::Time time, std::function<void()> action) {
  {
    std::lock_guard lock(mutex_);
    once_.emplace(time, std::move(action));
  }
  changed_.notify_all();
}

void JobMaintenance::Loop() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    RunDue(lock);
    if (stopping_) return;
    const absl::Duration pause = std::min(NextTime() - absl::Now(), absl::Hours(1));
    // Rounded up: a time that is almost there would be waited for in a busy loop.
    changed_.wait_for(lock, absl::ToChronoMilliseconds(pause) + std::chrono::milliseconds(1));
  }
}

void JobMaintenance::RunDue(std::unique_lock<std::mutex>& lock) {
  while (!once_.empty() && once_.begin()->first <= absl::Now()) {
    const std::function<void()> action = std::move(once_.begin()->second);
    once_.erase(once_.begin());
    lock.unlock();
    action();
    lock.lock();
  }
  for (Repeated& repeated : repeated_) {
    if (stopping_ || repeated.next > absl::Now()) continue;
    lock.unlock();
    RunTask(repeated);
    lock.lock();
  }
}

void JobMaintenance::RunTask(Repeated& repeated) {
  const Status status = repeated.task.run();
  const absl::Time now = absl::Now();
  repeated.next = now + repeated.task.interval * (1.0 + random_.Uniform(-kJitter, kJitter));
  if (status.ok() || now < last_complaint_ + kComplaintInterval) return;
  last_complaint_ = now;
  log_.OnTaskFailed(repeated.task.name, status);
}

absl::Time JobMaintenance::NextTime() const {
  absl::Time next = once_.empty() ? absl::InfiniteFuture() : once_.begin()->first;
  for (const Repeated& repeated : repeated_) next = std::min(next, repeated.next);
  return next;
}

}  // namespace poise::engine
