#ifndef POISE_CLIENT_PUSH_STREAM_H_
#define POISE_CLIENT_PUSH_STREAM_H_

#include <memory>
#include <optional>

#include "core/api/push_forecast.h"
#include "core/base/status.h"

namespace poise::client {

/// The frames of one forecast, in order, as the server makes them; what nobody reads yet is not
/// made. Must not outlive its Client.
/// Threads: Scene and Next by one caller at a time, Cancel from any thread.
class PushStream {
 public:
  /// Built by Client::ForecastPush.
  class Call;
  explicit PushStream(std::unique_ptr<Call> call);
  /// Cancels what was not read.
  ~PushStream();

  /// Who is in the forecast; waits for it. Call it once, before Next.
  StatusOr<api::PushForecastScene> Scene();
  /// Waits for the next frame; nullopt after the last. Errors: the server's, kCancelled after
  /// Cancel(), kInternal BAD_ANSWER, and those of transport_error.h. After an error or the end it
  /// says the same again.
  StatusOr<std::optional<api::PushForecastFrame>> Next();

  /// Stops the work on the server; a Next() that waits returns.
  void Cancel();

 private:
  std::unique_ptr<Call> call_;
};

}  // namespace poise::client

#endif  // POISE_CLIENT_PUSH_STREAM_H_
