#ifndef POISE_CORE_LEARNING_NN_GUARD_H_
#define POISE_CORE_LEARNING_NN_GUARD_H_

#include <string_view>
#include <type_traits>
#include <utility>

#include "absl/functional/function_ref.h"
#include "core/base/status.h"

/// LibTorch reports wrong shapes, lack of memory and so on by exceptions: here, and nowhere else,
/// they become statuses.
namespace poise::learning {

/// Runs `work`. Errors: its own; kResourceExhausted OUT_OF_MEMORY for std::bad_alloc; kInternal
/// NETWORK_FAILED for every other exception, with the first line of its text behind `what`.
Status GuardStatus(std::string_view what, absl::FunctionRef<Status()> work);

/// The same for work that returns a StatusOr: `Guard("decode", [&] { return net->Decode(z); })`.
template <typename Work>
auto Guard(std::string_view what, Work&& work) -> std::invoke_result_t<Work> {
  using Result = std::invoke_result_t<Work>;
  if constexpr (std::is_same_v<Result, Status>) {
    return GuardStatus(what, work);
  } else {
    Result result = absl::UnknownError("not run");
    const Status status = GuardStatus(what, [&] {
      result = work();
      return result.status();
    });
    if (!status.ok()) return status;
    return result;
  }
}

}  // namespace poise::learning

#endif  // POISE_CORE_LEARNING_NN_GUARD_H_
