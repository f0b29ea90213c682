#ifndef POISE_CORE_BASE_THREAD_POOL_H_
#define POISE_CORE_BASE_THREAD_POOL_H_

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace poise::base {

/// A fixed number of threads that take tasks first come, first served. Streams that submit one
/// small task at a time therefore share the pool fairly.
/// Threads: Submit may be called from anywhere, also from a task.
class ThreadPool {
 public:
  /// `threads` <= 0 means one per CPU that this process may use.
  explicit ThreadPool(int threads);
  /// Runs what was submitted, then joins.
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  void Submit(std::function<void()> task);
  int size() const { return static_cast<int>(threads_.size()); }
  /// Tasks that wait for a thread.
  size_t queued() const;

 private:
  void Loop();

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

/// CPUs that the scheduler and the cgroup quota leave to this process, at least 1.
int AvailableCpus();

}  // namespace poise::base

#endif  // POISE_CORE_BASE_THREAD_POOL_H_
