#include "core/engine/event_hub.h"

#include <utility>
#include <vector>

namespace poise::engine {

std::unique_ptr<EventHub::Subscription> EventHub::Subscribe(const std::string& job,
                                                            std::function<void()> on_news) {
  std::lock_guard lock(mutex_);
  const int64_t number = ++last_number_;
  subscribers_[job][number] = std::make_shared<const std::function<void()>>(std::move(on_news));
  return std::unique_ptr<Subscription>(new Subscription(*this, job, number));
}

void EventHub::Publish(const std::string& job) {
  std::vector<Callback> callbacks;
  {
    std::lock_guard lock(mutex_);
    const auto of_job = subscribers_.find(job);
    if (of_job == subscribers_.end()) return;
    for (const auto& [number, callback] : of_job->second) callbacks.push_back(callback);
  }
  for (const Callback& callback : callbacks) (*callback)();
}

void EventHub::PublishToAll() {
  std::vector<Callback> callbacks;
  {
    std::lock_guard lock(mutex_);
    for (const auto& [job, of_job] : subscribers_) {
      for (const auto& [number, callback] : of_job) callbacks.push_back(callback);
    }
  }
  for (const Callback& callback : callbacks) (*callback)();
}

void EventHub::Remove(const std::string& job, int64_t number) {
  std::lock_guard lock(mutex_);
  const auto of_job = subscribers_.find(job);
  of_job->second.erase(number);
  if (of_job->second.empty()) subscribers_.erase(of_job);
}

}  // namespace poise::engine
