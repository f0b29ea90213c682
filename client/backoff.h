#ifndef POISE_CLIENT_BACKOFF_H_
#define POISE_CLIENT_BACKOFF_H_

#include <optional>

#include "absl/time/time.h"
#include "core/base/status.h"

namespace poise::client {

struct BackoffConfig {
  absl::Duration first = absl::Milliseconds(100);
  absl::Duration longest = absl::Seconds(2);
  absl::Duration outage = absl::Seconds(60);  ///< without a sign of life; then it is given up
};

/// True for errors that say nothing about the request: the server is gone, goes away, or has no
/// room now and says when it may.
bool IsTransient(const Status& status);

/// How long to wait before something that failed is tried again: doubled from try to try, drawn
/// from the upper half so that many clients do not come back at once, never shorter than the server
/// asked for.
/// Threads: one caller at a time.
class Backoff {
 public:
  explicit Backoff(BackoffConfig config) : config_(config), delay_(config.first) {}

  /// nullopt: the error is not transient, or the outage has lasted too long.
  std::optional<absl::Duration> Next(const Status& failure);
  /// The server answered: an outage would begin only now.
  void NoteAnswer() { outage_begin_ = absl::InfiniteFuture(); }
  /// It answered with something new: the next wait is short again.
  void NoteProgress();

 private:
  const BackoffConfig config_;
  absl::Duration delay_;
  absl::Time outage_begin_ = absl::InfiniteFuture();  // InfiniteFuture while there is none
};

}  // namespace poise::client

#endif  // POISE_CLIENT_BACKOFF_H_
