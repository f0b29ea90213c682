#include "core/learning/nn/guard.h"

#include <c10/util/Exception.h>
#include <fmt/format.h>

#include <exception>
#include <new>
#include <string>

namespace poise::learning {
namespace {

Status Failed(std::string_view what, std::string_view text) {
  // LibTorch appends a stack trace to its sentence.
  return base::Internal("NETWORK_FAILED",
                        fmt::format("{}: {}", what, text.substr(0, text.find('\n'))));
}

}  // namespace

Status GuardStatus(std::string_view what, absl::FunctionRef<Status()> work) {
  try {
    return work();
  } catch (const c10::Error& error) {
    return Failed(what, error.what_without_backtrace());
  } catch (const std::bad_alloc&) {
    return base::ResourceExhausted("OUT_OF_MEMORY", "",
                                   fmt::format("{}: there is not enough memory", what));
  } catch (const std::exception& error) {
    return Failed(what, error.what());
  }
}

}  // namespace poise::learning
