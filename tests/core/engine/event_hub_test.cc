#include "core/engine/event_hub.h"

#include <gtest/gtest.h>

namespace poise::engine {
namespace {

TEST(EventHubTest, NewsReachThoseWhoWatchThatJob) {
  EventHub hub;
  int first = 0, second = 0;
  auto of_a = hub.Subscribe("a", [&] { ++first; });
  auto of_b = hub.Subscribe("b", [&] { ++second; });
  hub.Publish("a");
  hub.Publish("nobody's");
  EXPECT_EQ(first, 1);
  EXPECT_EQ(second, 0);
  hub.PublishToAll();
  EXPECT_EQ(first, 2);
  EXPECT_EQ(second, 1);
  of_a.reset();
  hub.Publish("a");
  EXPECT_EQ(first, 2);
}

TEST(EventHubTest, SubscriberMayLeaveWhileItIsToldNews) {
  EventHub hub;
  std::unique_ptr<EventHub::Subscription> self;
  int others = 0;
  self = hub.Subscribe("a", [&] { self.reset(); });
  const auto other = hub.Subscribe("a", [&] { ++others; });
  hub.Publish("a");
  hub.Publish("a");
  EXPECT_EQ(others, 2);
}

}  // namespace
}  // namespace poise::engine
