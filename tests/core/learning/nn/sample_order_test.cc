#include "core/learning/nn/sample_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace poise::learning {
namespace {

std::vector<int64_t> Copy(std::span<const int64_t> batch) { return {batch.begin(), batch.end()}; }

TEST(SampleOrderTest, AnEpochSeesEverySampleOnceInANewOrder) {
  SampleOrder order(12, 4, false, 1);
  ASSERT_EQ(order.batches_per_epoch(), 3);
  std::vector<std::vector<int64_t>> epochs;
  for (int64_t epoch = 0; epoch < 2; ++epoch) {
    std::vector<int64_t> seen;
    for (int64_t i = 0; i < 3; ++i) {
      for (const int64_t sample : order.Batch(epoch * 3 + i)) seen.push_back(sample);
    }
    EXPECT_EQ(std::set<int64_t>(seen.begin(), seen.end()).size(), 12u);
    EXPECT_EQ(*std::max_element(seen.begin(), seen.end()), 11);
    epochs.push_back(seen);
  }
  EXPECT_NE(epochs[0], epochs[1]);
}

TEST(SampleOrderTest, AStepIsTheSameWhereverTheRunBegins) {
  for (const bool with_replacement : {false, true}) {
    SampleOrder whole(50, 8, with_replacement, 3);
    std::vector<std::vector<int64_t>> batches;
    for (int64_t step = 0; step < 20; ++step) batches.push_back(Copy(whole.Batch(step)));
    SampleOrder resumed(50, 8, with_replacement, 3);
    for (int64_t step = 13; step < 20; ++step) EXPECT_EQ(Copy(resumed.Batch(step)), batches[step]);
    SampleOrder other_seed(50, 8, with_replacement, 4);
    EXPECT_NE(Copy(other_seed.Batch(0)), batches[0]);
  }
}

TEST(SampleOrderTest, ASetSmallerThanABatchIsOneBatch) {
  SampleOrder order(3, 8, false, 1);
  EXPECT_EQ(order.Batch(0).size(), 3u);
  SampleOrder with_replacement(3, 8, true, 1);
  EXPECT_EQ(with_replacement.Batch(0).size(), 8u);
}

TEST(SampleOrderTest, WithReplacementEverySampleIsEquallyLikely) {
  SampleOrder order(5, 1000, true, 1);
  std::vector<int> counts(5);
  for (const int64_t sample : order.Batch(7)) ++counts[sample];
  // Five standard deviations of a binomial with n = 1000, p = 0.2.
  for (const int count : counts) EXPECT_NEAR(count, 200, 64);
}

}  // namespace
}  // namespace poise::learning
