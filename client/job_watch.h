#ifndef POISE_CLIENT_JOB_WATCH_H_
#define POISE_CLIENT_JOB_WATCH_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "absl/time/time.h"
#include "core/api/job.h"
#include "core/base/status.h"

namespace poise::client {

struct WatchOptions {
  int64_t after_seq = 0;  ///< events with a greater number only; 0: from the beginning
  absl::Time deadline = absl::InfiniteFuture();
};

/// What happens to a job, as it happens. A connection that breaks, a server that restarts or moves
/// on is joined again behind the last event, with waits between the tries, for as long as
/// ClientOptions::outage allows: every state change comes once, in order, and the terminal one
/// last. Must not outlive its Client. Threads: Next and job by one caller at a time, Cancel from
/// any thread.
class JobWatch {
 public:
  /// Built by Client::WatchJob.
  class Stream;
  explicit JobWatch(std::unique_ptr<Stream> stream);
  ~JobWatch();

  /// Waits for the next event; nullopt behind the terminal one. Errors: the server's (kNotFound
  /// JOB_NOT_FOUND), kCancelled after Cancel(), kDeadlineExceeded, and those of transport_error.h.
  /// After an error or the end it says the same again.
  StatusOr<std::optional<api::JobEvent>> Next();

  /// The newest that is known of the job: as the server told it at the (last) joining, with the
  /// events since. Empty id before the first Next().
  const api::Job& job() const;
  /// Where another watch would have to go on.
  int64_t last_seq() const;

  /// Ends the watch, not the job; a Next() that waits returns.
  void Cancel();

 private:
  std::unique_ptr<Stream> stream_;
};

}  // namespace poise::client

#endif  // POISE_CLIENT_JOB_WATCH_H_
