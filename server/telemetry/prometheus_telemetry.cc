#include "server/telemetry/prometheus_telemetry.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

namespace poise::server {
namespace {

class PrometheusCounter : public base::Counter {
 public:
  explicit PrometheusCounter(prometheus::Counter& counter) : counter_(counter) {}
  void Increment(double by) override { counter_.Increment(by); }

 private:
  prometheus::Counter& counter_;
};

class PrometheusGauge : public base::Gauge {
 public:
  explicit PrometheusGauge(prometheus::Gauge& gauge) : gauge_(gauge) {}
  void Set(double value) override { gauge_.Set(value); }
  void Add(double by) override { gauge_.Increment(by); }

 private:
  prometheus::Gauge& gauge_;
};

class PrometheusHistogram : public base::Histogram {
 public:
  explicit PrometheusHistogram(prometheus::Histogram& histogram) : histogram_(histogram) {}
  void Observe(double value) override { histogram_.Observe(value); }

 private:
  prometheus::Histogram& histogram_;
};

prometheus::Histogram::BucketBoundaries Seconds() {
  return {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100};
}

}  // namespace

PrometheusTelemetry::PrometheusTelemetry() : registry_(std::make_shared<prometheus::Registry>()) {}
PrometheusTelemetry::~PrometheusTelemetry() = default;

base::Counter& PrometheusTelemetry::counter(const std::string& name, const std::string& help,
                                            const base::Labels& labels) {
  std::lock_guard lock(mutex_);
  auto& entry = counters_[{name, labels}];
  if (!entry) {
    auto& family = prometheus::BuildCounter().Name(name).Help(help).Register(*registry_);
    entry = std::make_unique<PrometheusCounter>(family.Add(labels));
  }
  return *entry;
}

base::Gauge& PrometheusTelemetry::gauge(const std::string& name, const std::string& help,
                                        const base::Labels& labels) {
  std::lock_guard lock(mutex_);
  auto& entry = gauges_[{name, labels}];
  if (!entry) {
    auto& family = prometheus::BuildGauge().Name(name).Help(help).Register(*registry_);
    entry = std::make_unique<PrometheusGauge>(family.Add(labels));
  }
  return *entry;
}

base::Histogram& PrometheusTelemetry::histogram(const std::string& name, const std::string& help,
                                                const base::Labels& labels) {
  std::lock_guard lock(mutex_);
  auto& entry = histograms_[{name, labels}];
  if (!entry) {
    auto& family = prometheus::BuildHistogram().Name(name).Help(help).Register(*registry_);
    entry = std::make_unique<PrometheusHistogram>(family.Add(labels, Seconds()));
  }
  return *entry;
}

Status PrometheusTelemetry::Expose(const std::string& address) {
  POISE_ASSIGN_OR_RETURN(page_, MetricsPage::Open(address, [this] { return Text(); }));
  return absl::OkStatus();
}

std::string PrometheusTelemetry::Text() const {
  return prometheus::TextSerializer().Serialize(registry_->Collect());
}

}  // namespace poise::server
