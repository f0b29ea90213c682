#include "server/worker/lease_keeper.h"

#include <algorithm>
#include <utility>

#include "server/worker/persistence.h"

namespace poise::worker {
namespace {

// Of a heartbeat that the server does not hold.
constexpr absl::Duration kAtOnce = absl::ZeroDuration();

}  // namespace

LeaseKeeper::LeaseKeeper(LeaseKeeperConfig config, WorkerClient& client, const jobs::Lease& lease,
                         base::CancellationToken stop)
    : config_(config),
      client_(client),
      fence_(lease.fence),
      stop_(std::move(stop)),
      lease_end_(Clock::now() + absl::ToChronoNanoseconds(lease.expires_in)),
      holder_([this] { HoldHeartbeats(); }),
      sender_([this] { SendProgress(); }) {}

LeaseKeeper::~LeaseKeeper() {
  {
    std::lock_guard lock(mutex_);
    done_ = true;
  }
  changed_.notify_all();
  hold_breaker_.Break();
  progress_breaker_.Break();
  holder_.join();
  sender_.join();
}

void LeaseKeeper::Report(const base::Progress& progress) {
  std::lock_guard lock(mutex_);
  pending_ = progress;
  changed_.notify_all();
}

void LeaseKeeper::FlushProgress(absl::Duration limit) {
  std::unique_lock lock(mutex_);
  flushing_ = true;
  changed_.notify_all();
  changed_.wait_for(lock, absl::ToChronoNanoseconds(limit), [this] {
    return (!pending_ && !sending_) || !flushing_ || verdict_ == Verdict::kLost;
  });
}

Verdict LeaseKeeper::verdict() const {
  std::lock_guard lock(mutex_);
  return verdict_;
}

void LeaseKeeper::Learn(const Status& status) {
  const std::string reason = base::ErrorReason(status);
  if (reason != "LEASE_LOST" && reason != "JOB_NOT_FOUND") return;
  std::lock_guard lock(mutex_);
  Decide(Verdict::kLost);
}

void LeaseKeeper::Decide(Verdict verdict) {
  if (verdict_ == Verdict::kLost || verdict == verdict_) return;
  verdict_ = verdict;
  stop_.Cancel();
  changed_.notify_all();
}

absl::Duration LeaseKeeper::Left() const { return absl::FromChrono(lease_end_ - Clock::now()); }

bool LeaseKeeper::Beat(const std::optional<base::Progress>& progress, absl::Duration hold,
                       CallBreaker& breaker, std::unique_lock<std::mutex>& lock) {
  const absl::Duration limit = std::min(hold + config_.answer_limit, Left());
  lock.unlock();
  const auto reply = client_.Heartbeat(fence_, progress, hold, limit, breaker);
  if (!reply.ok()) Learn(reply.status());
  lock.lock();
  if (!reply.ok()) return false;
  lease_end_ = Clock::now() + absl::ToChronoNanoseconds(reply->expires_in);
  if (reply->directive == jobs::Directive::kCancel) Decide(Verdict::kCancel);
  return true;
}

void LeaseKeeper::HoldHeartbeats() {
  Pauses pauses;
  std::unique_lock lock(mutex_);
  while (!done_ && verdict_ != Verdict::kLost) {
    const Clock::time_point begin = Clock::now();
    // Once a wish to cancel is known there is nothing to hold for.
    const bool holds = verdict_ == Verdict::kKeep;
    const bool kept =
        Beat(std::nullopt, holds ? config_.heartbeat_interval : kAtOnce, hold_breaker_, lock);
    if (kept) pauses.Reset();
    const absl::Duration pause =
        kept ? config_.shortest_interval - absl::FromChrono(Clock::now() - begin) : pauses.Next();
    changed_.wait_for(lock, absl::ToChronoNanoseconds(pause),
                      [this] { return done_ || verdict_ == Verdict::kLost; });
  }
}

void LeaseKeeper::SendProgress() {
  std::unique_lock lock(mutex_);
  while (!done_ && verdict_ != Verdict::kLost) {
    const Clock::time_point now = Clock::now();
    if (now >= lease_end_) {
      Decide(Verdict::kLost);
    } else if (pending_ && (flushing_ || now >= next_progress_)) {
      next_progress_ = now + absl::ToChronoNanoseconds(config_.progress_interval);
      const base::Progress progress = *std::exchange(pending_, std::nullopt);
      sending_ = true;
      const bool told = Beat(progress, kAtOnce, progress_breaker_, lock);
      sending_ = false;
      if (!told) flushing_ = false;
      if (!told && !pending_) pending_ = progress;  // with the next one
      changed_.notify_all();
    } else {
      changed_.wait_until(lock, pending_ ? std::min(lease_end_, next_progress_) : lease_end_);
    }
  }
}

}  // namespace poise::worker
