#ifndef POISE_SERVER_TELEMETRY_PROMETHEUS_TELEMETRY_H_
#define POISE_SERVER_TELEMETRY_PROMETHEUS_TELEMETRY_H_

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "core/base/status.h"
#include "core/base/telemetry.h"
#include "server/telemetry/metrics_page.h"

namespace prometheus {
class Registry;
}  // namespace prometheus

namespace poise::server {

/// The counters of core/base/telemetry.h, as Prometheus reads them.
/// Threads: all members may be called from any thread.
class PrometheusTelemetry : public base::Telemetry {
 public:
  PrometheusTelemetry();
  ~PrometheusTelemetry() override;

  base::Counter& counter(const std::string& name, const std::string& help,
                         const base::Labels& labels) override;
  base::Gauge& gauge(const std::string& name, const std::string& help,
                     const base::Labels& labels) override;
  base::Histogram& histogram(const std::string& name, const std::string& help,
                             const base::Labels& labels) override;

  /// Serves http://ADDR:PORT/metrics. Errors: kFailedPrecondition CANNOT_LISTEN.
  Status Expose(const std::string& address);

  /// All values in the text format.
  std::string Text() const;

 private:
  using Key = std::pair<std::string, base::Labels>;

  std::shared_ptr<prometheus::Registry> registry_;
  std::mutex mutex_;
  std::map<Key, std::unique_ptr<base::Counter>> counters_;
  std::map<Key, std::unique_ptr<base::Gauge>> gauges_;
  std::map<Key, std::unique_ptr<base::Histogram>> histograms_;
  std::unique_ptr<MetricsPage> page_;  // last: it reads the others
};

}  // namespace poise::server

#endif  // POISE_SERVER_TELEMETRY_PROMETHEUS_TELEMETRY_H_
