#include "server/shutdown_signal.h"

#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>

#include "absl/time/clock.h"

namespace poise::server {
namespace {

int event_descriptor = -1;

void OnSignal(int) {
  const int saved_errno = errno;
  const uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = write(event_descriptor, &one, sizeof(one));
  errno = saved_errno;
}

}  // namespace

void CatchShutdownSignals() {
  event_descriptor = eventfd(0, EFD_CLOEXEC | EFD_SEMAPHORE);
  struct sigaction action {};
  action.sa_handler = OnSignal;
  action.sa_flags = SA_RESTART;
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
  signal(SIGPIPE, SIG_IGN);
}

bool WaitForShutdownSignal(absl::Duration timeout) {
  const absl::Time end = absl::Now() + timeout;
  while (true) {
    const absl::Duration left = end - absl::Now();
    if (timeout != absl::InfiniteDuration() && left <= absl::ZeroDuration()) return false;
    pollfd waiting{.fd = event_descriptor, .events = POLLIN, .revents = 0};
    const int milliseconds =
        static_cast<int>(absl::ToInt64Milliseconds(std::min(left, absl::Hours(1)))) + 1;
    if (poll(&waiting, 1, milliseconds) <= 0) continue;
    uint64_t count = 0;
    return read(event_descriptor, &count, sizeof(count)) == sizeof(count);
  }
}

}  // namespace poise::server
