#ifndef POISE_CORE_LEARNING_NN_SAMPLE_ORDER_H_
#define POISE_CORE_LEARNING_NN_SAMPLE_ORDER_H_

#include <cstdint>
#include <span>
#include <vector>

namespace poise::learning {

/// Which samples each step of a training run sees: a function of seed and step alone, so that a
/// resumed run needs no memory of it.
/// Threads: one caller at a time.
class SampleOrder {
 public:
  /// Counts > 0. With replacement every sample of a batch is drawn anew. Otherwise an epoch is a
  /// new permutation of all samples, cut into batches; what does not fill the last batch is left
  /// out of that epoch, and a set smaller than a batch is one batch.
  SampleOrder(int64_t num_samples, int batch_size, bool with_replacement, uint64_t seed);

  int64_t batches_per_epoch() const { return batches_per_epoch_; }
  /// Valid until the next call.
  std::span<const int64_t> Batch(int64_t step);

 private:
  void Shuffle(int64_t epoch);

  const int64_t num_samples_;
  const int64_t batch_size_;
  const bool with_replacement_;
  const uint64_t seed_;
  const int64_t batches_per_epoch_;
  int64_t epoch_ = -1;          // of `order_`
  std::vector<int64_t> order_;  // a permutation, or the one batch drawn with replacement
};

}  // namespace poise::learning

#endif  // POISE_CORE_LEARNING_NN_SAMPLE_ORDER_H_
