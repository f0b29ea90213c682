#include "core/runtime/serving/load_gate.h"

#include <fmt/format.h>

#include <algorithm>

#include "absl/time/clock.h"

namespace poise::serving {
namespace {

constexpr absl::Duration kStretch = absl::Seconds(1);
constexpr uint32_t kGoldenStep = 2654435769u;  // 2^32 / golden ratio: steps that fill [0, 1) evenly

}  // namespace

LoadGate::LoadGate(const ServingConfig& config, base::Telemetry& telemetry,
                   const base::Labels& labels)
    : config_(config),
      inside_gauge_(
          telemetry.gauge("poise_predict_requests", "Predictions at work or waiting", labels)),
      refused_(telemetry.counter("poise_predict_refused_total",
                                 "Predictions refused because too many were at work", labels)),
      begin_(absl::Now()) {}

StatusOr<LoadGate::Place> LoadGate::Enter() {
  std::lock_guard lock(mutex_);
  if (inside_ < config_.max_requests) {
    inside_gauge_.Set(++inside_);
    return Place(shared_from_this());
  }
  refused_.Increment();
  Turn(absl::Now());
  ++current_.refused;
  return base::WithRetryDelay(
      base::ResourceExhausted(
          "MODEL_BUSY", "model",
          fmt::format("{} requests to this model are at work or wait, at most {}", inside_,
                      config_.max_requests)),
      RetryDelay());
}

void LoadGate::Leave() {
  std::lock_guard lock(mutex_);
  inside_gauge_.Set(--inside_);
  Turn(absl::Now());
  ++current_.served;
}

void LoadGate::Turn(absl::Time now) {
  if (now - begin_ < kStretch) return;
  last_ = now - begin_ < 2 * kStretch ? std::exchange(current_, {}) : Tally{};
  current_ = {};
  begin_ = now;
}

absl::Duration LoadGate::RetryDelay() {
  const Tally recent{.served = std::max(last_.served, current_.served),
                     .refused = std::max(last_.refused, current_.refused)};
  const double rate = std::max<double>(recent.served, 1) / absl::ToDoubleSeconds(kStretch);
  const double seconds = static_cast<double>(inside_ + recent.refused) / rate;
  spread_ += kGoldenStep;
  const double spread = 0.5 + spread_ * 0x1p-32;
  return std::clamp(absl::Seconds(seconds * spread), config_.least_retry, config_.most_retry);
}

}  // namespace poise::serving
