#ifndef POISE_TESTS_CORE_RUNTIME_JOBS_HELD_CALL_H_
#define POISE_TESTS_CORE_RUNTIME_JOBS_HELD_CALL_H_

#include <atomic>
#include <functional>
#include <future>
#include <string>
#include <utility>

#include "core/base/fail_point.h"

namespace poise::testing {

/// A call on a thread of its own that is held at a fail-point until it is let go: whatever the test
/// does meanwhile comes between the call's begin and its effect.
template <typename Answer>
class HeldCall {
 public:
  /// Returns when the call has reached the fail-point; other callers pass it.
  HeldCall(const char* fail_point, std::function<Answer()> call) : fail_point_(fail_point) {
    base::SetFailPoint(fail_point_, [this] {
      if (taken_.exchange(true)) return;
      reached_.set_value();
      go_.get_future().wait();
    });
    answer_ = std::async(std::launch::async, std::move(call));
    reached_.get_future().wait();
    base::SetFailPoint(fail_point_, nullptr);
  }
  ~HeldCall() {
    if (answer_.valid()) (void)LetGo();
  }
  HeldCall(const HeldCall&) = delete;
  HeldCall& operator=(const HeldCall&) = delete;

  Answer LetGo() {
    go_.set_value();
    return answer_.get();
  }

 private:
  const std::string fail_point_;
  std::atomic<bool> taken_ = false;
  std::promise<void> reached_, go_;
  std::future<Answer> answer_;
};

}  // namespace poise::testing

#endif  // POISE_TESTS_CORE_RUNTIME_JOBS_HELD_CALL_H_
