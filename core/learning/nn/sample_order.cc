#include "core/learning/nn/sample_order.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/base/random.h"

namespace poise::learning {

SampleOrder::SampleOrder(int64_t num_samples, int batch_size, bool with_replacement, uint64_t seed)
    : num_samples_(num_samples),
      batch_size_(with_replacement ? batch_size : std::min<int64_t>(batch_size, num_samples)),
      with_replacement_(with_replacement),
      seed_(seed),
      batches_per_epoch_(std::max<int64_t>(1, num_samples / batch_size_)) {}

std::span<const int64_t> SampleOrder::Batch(int64_t step) {
  if (with_replacement_) {
    base::Random random(base::DeriveSeed(seed_, {static_cast<uint64_t>(step)}));
    order_.resize(batch_size_);
    for (int64_t& sample : order_) sample = static_cast<int64_t>(random.Index(num_samples_));
    return order_;
  }
  if (const int64_t epoch = step / batches_per_epoch_; epoch != epoch_) Shuffle(epoch);
  const size_t first = step % batches_per_epoch_ * batch_size_;
  return std::span<const int64_t>(order_).subspan(first, batch_size_);
}

void SampleOrder::Shuffle(int64_t epoch) {
  epoch_ = epoch;
  base::Random random(base::DeriveSeed(seed_, {static_cast<uint64_t>(epoch)}));
  order_.resize(num_samples_);
  std::iota(order_.begin(), order_.end(), 0);
  for (size_t i = order_.size(); i > 1; --i) std::swap(order_[i - 1], order_[random.Index(i)]);
}

}  // namespace poise::learning
