#ifndef POISE_SERVER_HANDLERS_GUARD_H_
#define POISE_SERVER_HANDLERS_GUARD_H_

#include <exception>
#include <new>

#include "core/base/status.h"
#include "server/admission/admission.h"
#include "server/log.h"

namespace poise::server {

/// Runs `work` (a callable that returns Status or StatusOr) for a call. An exception, which none of
/// our own code throws on purpose, becomes an error without its text: that goes to the log.
template <typename Work>
auto Guarded(const Call& call, Work work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return base::WithRetryDelay(
        base::ResourceExhausted("OUT_OF_MEMORY", "", "the server has no memory left for this call"),
        absl::Seconds(5));
  } catch (const std::exception& error) {
    Log(level::err, "exception", {{"request_id", call.request_id()}, {"what", error.what()}});
    return base::Internal("UNEXPECTED_EXCEPTION",
                          "the server failed; its log has the reason under this request id");
  }
}

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_GUARD_H_
