#ifndef POISE_CORE_ENGINE_LEASE_WAITERS_H_
#define POISE_CORE_ENGINE_LEASE_WAITERS_H_

#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "core/runtime/jobs/job_store.h"

namespace poise::engine {

/// Workers that wait for a job. One job wakes one worker, not all: of each group that asks for the
/// same queues and kinds the one that waits longest. Who was woken and then took a job, or went
/// away, wakes the next of its group, so a wake-up is never lost. A waiting worker costs an entry
/// here and no thread.
/// Threads: all members may be called from any thread.
class LeaseWaiters {
  struct Group;

 public:
  /// One worker's wait. Leaves with its destructor.
  class Waiter {
   public:
    ~Waiter();
    Waiter(const Waiter&) = delete;
    Waiter& operator=(const Waiter&) = delete;

    /// From now on a job may wake this worker. Arm first and claim then, and nothing is missed.
    void Arm();
    /// This worker got a job; there may be another for the next one.
    void PassOn();

   private:
    friend class LeaseWaiters;
    Waiter(LeaseWaiters& waiters, std::map<std::string, Group>::iterator group,
           std::function<void()> wake);

    LeaseWaiters& waiters_;
    const std::map<std::string, Group>::iterator group_;
    const std::shared_ptr<const std::function<void()>> wake_;
    bool waiting_ = false;  // at `place_` in the group's list
    std::list<Waiter*>::iterator place_;
    bool woken_ = false;  // since the last Arm
  };

  /// `wake` must be quick: the store's writer waits for it.
  std::unique_ptr<Waiter> Join(const jobs::ClaimQuery& query, std::function<void()> wake);

  /// A job of this kind may have become claimable.
  void JobReady(std::string_view kind);
  /// Some job may have.
  void AnyJobReady();
  /// Wakes everybody: the reason lies outside the jobs.
  void WakeAll();

 private:
  using Wake = std::shared_ptr<const std::function<void()>>;
  struct Group {
    std::vector<std::string> kinds;  ///< empty: all
    std::list<Waiter*> waiting;      ///< longest first
    int members = 0;
  };

  static void TakeFirst(Group& group, std::vector<Wake>& wakes);
  static void Call(const std::vector<Wake>& wakes);

  std::mutex mutex_;
  std::map<std::string, Group> groups_;  // by what they ask for
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_LEASE_WAITERS_H_
