#include "server/worker/drain_signal.h"

#include <utility>

namespace poise::worker {

DrainStage DrainSignal::stage() const {
  std::lock_guard lock(mutex_);
  return stage_;
}

void DrainSignal::Advance(DrainStage stage) {
  std::lock_guard lock(mutex_);
  if (stage <= stage_) return;
  if (stage_ == DrainStage::kWork) {
    for (const auto& [listener, on_drain] : listeners_) on_drain();
  }
  stage_ = stage;
  changed_.notify_all();
}

bool DrainSignal::WaitFor(absl::Duration limit) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, absl::ToChronoNanoseconds(limit),
                           [this] { return stage_ != DrainStage::kWork; });
}

DrainSignal::Listener::Listener(DrainSignal& signal, std::function<void()> on_drain)
    : signal_(signal) {
  std::lock_guard lock(signal_.mutex_);
  if (signal_.stage_ != DrainStage::kWork) on_drain();
  signal_.listeners_[this] = std::move(on_drain);
}

DrainSignal::Listener::~Listener() {
  std::lock_guard lock(signal_.mutex_);
  signal_.listeners_.erase(this);
}

}  // namespace poise::worker
