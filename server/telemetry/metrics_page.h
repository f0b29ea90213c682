#ifndef POISE_SERVER_TELEMETRY_METRICS_PAGE_H_
#define POISE_SERVER_TELEMETRY_METRICS_PAGE_H_

#include <functional>
#include <memory>
#include <string>

#include "core/base/status.h"

namespace poise::server {

/// http://ADDR:PORT/metrics, as Prometheus reads it, on threads of its own; closed by the
/// destructor. (The server inside prometheus-cpp asks for stacks smaller than the thread-local data
/// of LibTorch's libraries and cannot start in this process.)
class MetricsPage {
 public:
  /// `text` makes the page, at each request. Errors: kFailedPrecondition CANNOT_LISTEN.
  static StatusOr<std::unique_ptr<MetricsPage>> Open(const std::string& address,
                                                     std::function<std::string()> text);
  ~MetricsPage();

 private:
  class Listener;
  explicit MetricsPage(std::unique_ptr<Listener> listener);

  std::unique_ptr<Listener> listener_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_TELEMETRY_METRICS_PAGE_H_
