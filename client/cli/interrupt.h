#ifndef POISE_CLIENT_CLI_INTERRUPT_H_
#define POISE_CLIENT_CLI_INTERRUPT_H_

#include <signal.h>

#include <atomic>
#include <functional>
#include <thread>

namespace poise::cli {

/// While it lives, Ctrl-C (or SIGTERM) runs a callback on a thread of its own instead of ending the
/// program; a second one ends the program at once. Make it before any other thread: threads that
/// exist already would still take the signal.
class InterruptHandler {
 public:
  /// `on_interrupt` runs at most once, on another thread.
  explicit InterruptHandler(std::function<void()> on_interrupt);
  ~InterruptHandler();
  InterruptHandler(const InterruptHandler&) = delete;
  InterruptHandler& operator=(const InterruptHandler&) = delete;

  bool interrupted() const { return interrupted_; }

 private:
  void Wait();

  std::function<void()> on_interrupt_;
  std::atomic<bool> interrupted_ = false;
  sigset_t old_mask_;
  int signal_fd_;
  int stop_fd_;
  std::thread thread_;
};

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_INTERRUPT_H_
