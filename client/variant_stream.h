#ifndef POISE_CLIENT_VARIANT_STREAM_H_
#define POISE_CLIENT_VARIANT_STREAM_H_

#include <memory>
#include <optional>

#include "core/api/augment_spec.h"
#include "core/base/status.h"

namespace poise::client {

/// The variants of one Augment call, in order, as the server makes them. Variants that nobody reads
/// yet are not made: the server waits. Must not outlive its Client.
/// Threads: Next by one caller at a time, Cancel from any thread.
class VariantStream {
 public:
  /// Built by Client::Augment.
  class Call;
  explicit VariantStream(std::unique_ptr<Call> call);
  /// Cancels what was not read.
  ~VariantStream();

  /// Waits for the next variant; nullopt after the last. Errors: the server's, kCancelled after
  /// Cancel(), and those of transport_error.h. After an error or the end it says the same again.
  StatusOr<std::optional<api::DeliveredVariant>> Next();

  /// Stops the work on the server; a Next() that waits returns.
  void Cancel();

 private:
  std::unique_ptr<Call> call_;
};

}  // namespace poise::client

#endif  // POISE_CLIENT_VARIANT_STREAM_H_
