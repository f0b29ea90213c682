#include "core/base/thread_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

namespace poise::base {
namespace {

TEST(ThreadPoolTest, RunsEveryTaskBeforeItIsGone) {
  std::atomic<int> done = 0;
  {
    ThreadPool pool(3);
    for (int i = 0; i < 1000; ++i) pool.Submit([&] { ++done; });
  }
  EXPECT_EQ(done, 1000);
}

TEST(ThreadPoolTest, ATaskMaySubmitTheNextOne) {
  std::promise<int> finished;
  ThreadPool pool(1);
  std::function<void(int)> step = [&](int i) {
    if (i == 100) {
      finished.set_value(i);
    } else {
      pool.Submit([&step, i] { step(i + 1); });
    }
  };
  pool.Submit([&] { step(0); });
  EXPECT_EQ(finished.get_future().get(), 100);
}

TEST(ThreadPoolTest, WhatATaskHoldsIsFreedWhenItEnds) {
  auto held = std::make_shared<int>(1);
  std::weak_ptr<int> watched = held;
  ThreadPool pool(1);
  pool.Submit([held = std::move(held)] {});
  std::promise<void> after;
  pool.Submit([&] { after.set_value(); });
  after.get_future().wait();
  EXPECT_TRUE(watched.expired());
}

TEST(ThreadPoolTest, ADefaultPoolHasOneThreadPerAvailableCpu) {
  EXPECT_EQ(ThreadPool(0).size(), AvailableCpus());
  EXPECT_GE(AvailableCpus(), 1);
}

}  // namespace
}  // namespace poise::base
