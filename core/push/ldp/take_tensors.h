#ifndef POISE_CORE_PUSH_LDP_TAKE_TENSORS_H_
#define POISE_CORE_PUSH_LDP_TAKE_TENSORS_H_

#include <torch/torch.h>

#include <span>

#include "core/push/ldp/pendulum_tensors.h"
#include "core/push/pendulum/pendulum.h"
#include "core/push/takes/push_protocol.h"
#include "core/push/takes/push_take.h"

namespace poise::push::ldp {

/// Takes as pendulums, padded to the largest number of people and frames among them. Ground frame,
/// relative to the hip of person 0 in frame 0; single precision. Pendulums are extracted as the
/// authors do it (PaperPendulumOf), since the released forces are made with theirs.
struct TakeTensors {
  /// (takes, people, frames): as recorded. Velocities are differences to the frame before, none in
  /// frame 0: the released push begins with the force that makes them from rest.
  PendulumTensors recorded;
  torch::Tensor hip;          ///< (takes, people, frames, 3) recorded
  torch::Tensor mass;         ///< (takes, people) [kg]
  torch::Tensor cart_height;  ///< (takes, people) [m] in frame 0
  torch::Tensor push;         ///< (takes, frames, 4) generalised force on person 0 (protocols A, C)
  torch::Tensor hip_push;     ///< (takes, frames, 2) [N] force at its hip (protocol B)
  torch::Tensor push_frames;  ///< (takes) D
  torch::Tensor mask;         ///< (takes, people, frames) 1 where something was recorded

  int64_t takes() const { return mask.size(0); }
  int64_t people() const { return mask.size(1); }
  int64_t frames() const { return mask.size(2); }
  torch::Tensor there() const { return mask.select(2, 0); }
  /// The same in another type of numbers, for tests.
  TakeTensors To(torch::ScalarType type) const;
};

/// `random` draws protocol C's noise.
TakeTensors MakeTakeTensors(std::span<const PushTake* const> takes, Protocol protocol,
                            base::Random& random);

/// The pendulum of a recorded pose, as the authors extract it.
PendulumPose RecordedPendulum(const TakePerson& person, int frame);

}  // namespace poise::push::ldp

#endif  // POISE_CORE_PUSH_LDP_TAKE_TENSORS_H_
