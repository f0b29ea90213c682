#ifndef POISE_SERVER_WORKER_PERSISTENCE_H_
#define POISE_SERVER_WORKER_PERSISTENCE_H_

#include <functional>

#include "absl/time/time.h"
#include "core/base/status.h"
#include "server/worker/worker_client.h"

namespace poise::worker {

/// How a call is repeated while the server does not answer.
struct PersistenceConfig {
  absl::Duration first_pause = absl::Milliseconds(100);
  absl::Duration longest_pause = absl::Seconds(2);
};

/// Pauses between tries: doubled each time, drawn from the upper half so that many workers do not
/// come back at once.
/// Threads: one caller at a time.
class Pauses {
 public:
  explicit Pauses(PersistenceConfig config = {}) : config_(config), pause_(config.first_pause) {}

  absl::Duration Next();
  void Reset() { pause_ = config_.first_pause; }

 private:
  const PersistenceConfig config_;
  absl::Duration pause_;
};

/// Sleeps for `pause`, but not much longer than until `give_up` is true.
void PauseUnless(const std::function<bool()>& give_up, absl::Duration pause);

inline const Status& StatusOf(const Status& status) { return status; }
template <typename Value>
const Status& StatusOf(const StatusOr<Value>& answer) {
  return answer.status();
}

/// Repeats `call` until its answer is definite (IsDefinite) or `give_up` is true; returns the last
/// answer.
template <typename Call>
auto Persist(const Call& call, const std::function<bool()>& give_up) -> decltype(call()) {
  Pauses pauses;
  while (true) {
    auto answer = call();
    if (IsDefinite(StatusOf(answer)) || give_up()) return answer;
    PauseUnless(give_up, pauses.Next());
  }
}

}  // namespace poise::worker

#endif  // POISE_SERVER_WORKER_PERSISTENCE_H_
