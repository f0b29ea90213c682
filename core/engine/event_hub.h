#ifndef POISE_CORE_ENGINE_EVENT_HUB_H_
#define POISE_CORE_ENGINE_EVENT_HUB_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace poise::engine {

/// Tells those who watch a job that there is something new; what it is they read from the store.
/// A waiting reader costs an entry here and no thread.
/// Threads: all members may be called from any thread.
class EventHub {
 public:
  /// Ends with its destructor; a call that is under way then may still arrive.
  class Subscription {
   public:
    ~Subscription() { hub_.Remove(job_, number_); }
    Subscription(const Subscription&) = delete;
    Subscription& operator=(const Subscription&) = delete;

   private:
    friend class EventHub;
    Subscription(EventHub& hub, std::string job, int64_t number)
        : hub_(hub), job_(std::move(job)), number_(number) {}

    EventHub& hub_;
    const std::string job_;
    const int64_t number_;
  };

  /// `on_news` must be quick: the store's writer waits for it. Subscribe first and read then, and
  /// nothing is missed.
  std::unique_ptr<Subscription> Subscribe(const std::string& job, std::function<void()> on_news);

  void Publish(const std::string& job);
  /// Calls every subscriber: the reason lies outside the jobs.
  void PublishToAll();

 private:
  using Callback = std::shared_ptr<const std::function<void()>>;
  void Remove(const std::string& job, int64_t number);

  std::mutex mutex_;
  int64_t last_number_ = 0;
  std::map<std::string, std::map<int64_t, Callback>> subscribers_;  // by job
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_EVENT_HUB_H_
