#ifndef POISE_TESTS_INTEGRATION_NEMESIS_H_
#define POISE_TESTS_INTEGRATION_NEMESIS_H_

#include <sys/types.h>

#include <random>
#include <set>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "tests/support/job_cluster.h"

namespace poise::testing {

/// What a nemesis has done so far.
struct Harm {
  int children_killed = 0;
  int supervisors_killed = 0;
  int servers_killed = 0;
  int children_paused = 0;
  int supervisors_paused = 0;

  int kills() const { return children_killed + supervisors_killed + servers_killed; }
  int pauses() const { return children_paused + supervisors_paused; }
  std::string ToString() const;
};

/// Kills and pauses the processes of a cluster, in an order that a seed determines. Whom it kills
/// it replaces; whom it pauses goes on after `pause`, which should exceed the lease.
/// Threads: one caller.
class Nemesis {
 public:
  Nemesis(JobCluster& cluster, std::vector<std::string> worker_flags, absl::Duration pause,
          uint64_t seed);
  /// Wakes who is still paused.
  ~Nemesis();

  /// One act of harm; also wakes those whose pause is over. Call it again and again.
  void Act();
  /// Waits until nobody is paused.
  void Rest();

  const Harm& harm() const { return harm_; }

 private:
  struct Paused {
    pid_t pid;
    absl::Time until;
  };

  void Wake(absl::Time now);
  bool IsPaused(pid_t pid) const;
  void Pause(pid_t pid);
  // A worker that is not paused.
  size_t RandomWorker();
  // A child of it, or 0.
  pid_t RandomChild(size_t worker);

  JobCluster& cluster_;
  const std::vector<std::string> worker_flags_;
  const absl::Duration pause_;
  std::mt19937 random_;
  std::vector<size_t> workers_;  // those that live
  std::vector<Paused> paused_;
  Harm harm_;
};

}  // namespace poise::testing

#endif  // POISE_TESTS_INTEGRATION_NEMESIS_H_
