#ifndef POISE_SERVER_SHUTDOWN_SIGNAL_H_
#define POISE_SERVER_SHUTDOWN_SIGNAL_H_

#include "absl/time/time.h"

/// SIGTERM and SIGINT as something to wait for. (Blocking them and calling sigwait would not do:
/// BLAS starts threads before main, which do not inherit the block.)
namespace poise::server {

/// Catches the signals from now on; call it once, before anything else. SIGPIPE is ignored.
void CatchShutdownSignals();

/// Waits for the next signal. False: none came within `timeout`.
bool WaitForShutdownSignal(absl::Duration timeout = absl::InfiniteDuration());

}  // namespace poise::server

#endif  // POISE_SERVER_SHUTDOWN_SIGNAL_H_
