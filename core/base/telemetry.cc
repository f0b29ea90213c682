#include "core/base/telemetry.h"

namespace poise::base {

Counter& Telemetry::counter(const std::string&, const std::string&, const Labels&) {
  static Counter none;
  return none;
}

Gauge& Telemetry::gauge(const std::string&, const std::string&, const Labels&) {
  static Gauge none;
  return none;
}

Histogram& Telemetry::histogram(const std::string&, const std::string&, const Labels&) {
  static Histogram none;
  return none;
}

Telemetry& Telemetry::None() {
  static Telemetry none;
  return none;
}

}  // namespace poise::base
