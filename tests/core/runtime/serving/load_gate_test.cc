#include "core/runtime/serving/load_gate.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace poise::serving {
namespace {

std::shared_ptr<LoadGate> Gate(const ServingConfig& config) {
  return std::make_shared<LoadGate>(config, base::Telemetry::None(), base::Labels{});
}

TEST(LoadGateTest, AsManyAsMayBeAreInsideAndAPlaceGivenBackIsFree) {
  const auto gate = Gate({.max_requests = 2});
  std::optional<LoadGate::Place> first = *gate->Enter();
  const auto second = gate->Enter();
  ASSERT_TRUE(second.ok());
  const Status refused = gate->Enter().status();
  EXPECT_TRUE(absl::IsResourceExhausted(refused));
  EXPECT_EQ(base::ErrorReason(refused), "MODEL_BUSY");
  EXPECT_TRUE(base::RetryDelay(refused).has_value());
  first.reset();
  EXPECT_TRUE(gate->Enter().ok());
}

TEST(LoadGateTest, TheMoreAreSentAwayTheLaterTheyShallComeAgain) {
  const auto gate = Gate({.max_requests = 1});
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(gate->Enter().ok());  // a hundred a second
  const auto inside = gate->Enter();
  std::vector<double> delays;
  for (int i = 0; i < 400; ++i) {
    delays.push_back(absl::ToDoubleSeconds(*base::RetryDelay(gate->Enter().status())));
  }
  EXPECT_NEAR(delays.front(), 0.1, 1e-9) << "at least that";
  // 400 more at 100 a second take four seconds, spread by half.
  double sum = 0;
  for (int i = 300; i < 400; ++i) {
    EXPECT_GE(delays[i], 1.5);
    EXPECT_LE(delays[i], 5.0);
    sum += delays[i] / 100;
  }
  EXPECT_NEAR(sum, 3.5, 0.4);
}

}  // namespace
}  // namespace poise::serving
