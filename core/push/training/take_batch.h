#ifndef POISE_CORE_PUSH_TRAINING_TAKE_BATCH_H_
#define POISE_CORE_PUSH_TRAINING_TAKE_BATCH_H_

#include <torch/torch.h>

#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/push/takes/push_protocol.h"
#include "core/push/takes/push_take.h"

namespace poise::push {

/// Takes as tensors, padded to the largest number of people and frames among them. Ground frame,
/// single precision.
struct TakeBatch {
  torch::Tensor hip;      ///< (takes, people, frames, 2) path of the hip from its place in frame 0
  torch::Tensor lean;     ///< (takes, people, frames, 2) theta, phi since frame 0
  torch::Tensor place;    ///< (takes, people, 2) of the hip in frame 0, from person 0's
  torch::Tensor push;     ///< (takes, people, frames, 2) force / mass, scaled by kPushScale
  torch::Tensor context;  ///< (takes, people, kContextSize)
  torch::Tensor mask;     ///< (takes, people, frames) 1 where something was recorded

  int64_t frames() const { return hip.size(2); }
  int64_t people() const { return hip.size(1); }
};

/// How takes are varied for training.
struct TakeVariation {
  bool mirror = false;     ///< half of the takes change left and right
  double still_share = 0;  ///< [0 to 1] of takes without a push, in which nobody moves
};

/// `random` draws protocol C's noise and the variation.
TakeBatch MakeBatch(std::span<const PushTake* const> takes, Protocol protocol,
                    const TakeVariation& variation, base::Random& random);

/// With more frames at the end, in which nothing is recorded and nobody is pushed.
TakeBatch Extended(TakeBatch batch, int64_t frames);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TRAINING_TAKE_BATCH_H_
