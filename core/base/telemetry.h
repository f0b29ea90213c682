#ifndef POISE_CORE_BASE_TELEMETRY_H_
#define POISE_CORE_BASE_TELEMETRY_H_

#include <map>
#include <memory>
#include <string>

/// Operational counters, declared here as interfaces that do nothing, so that the engine can count
/// without knowing who listens. server/telemetry implements them for Prometheus.
namespace poise::base {

using Labels = std::map<std::string, std::string>;

class Counter {
 public:
  virtual ~Counter() = default;
  virtual void Increment(double /*by*/ = 1) {}
};

class Gauge {
 public:
  virtual ~Gauge() = default;
  virtual void Set(double /*value*/) {}
  virtual void Add(double /*by*/) {}
};

class Histogram {
 public:
  virtual ~Histogram() = default;
  virtual void Observe(double /*value*/) {}
};

/// Hands out instruments; the same name and labels give the same instrument.
/// Threads: all members and all instruments may be used from any thread.
class Telemetry {
 public:
  virtual ~Telemetry() = default;
  virtual Counter& counter(const std::string& name, const std::string& help, const Labels& labels);
  virtual Gauge& gauge(const std::string& name, const std::string& help, const Labels& labels);
  /// Seconds, with buckets from 1 ms to 100 s.
  virtual Histogram& histogram(const std::string& name, const std::string& help,
                               const Labels& labels);

  /// The one that does nothing.
  static Telemetry& None();
};

}  // namespace poise::base

#endif  // POISE_CORE_BASE_TELEMETRY_H_
