#ifndef POISE_CORE_PUSH_TRAINING_POSE_NET_H_
#define POISE_CORE_PUSH_TRAINING_POSE_NET_H_

#include <torch/torch.h>

#include "core/push/learned/pose_config.h"

namespace poise::push {

/// People as sequences, padded to the longest; ground frame, pelvis of frame 0 at the origin.
struct PoseBatch {
  torch::Tensor
      hip;  ///< (people, frames + lookahead, 2) path of the hip, from its place in frame 0
  torch::Tensor lean;       ///< (people, frames, 2) theta, phi since frame 0
  torch::Tensor body;       ///< (people, kBodySize)
  torch::Tensor joints;     ///< (people, frames, kBodyJoints, 3) recorded, from the pelvis
  torch::Tensor height;     ///< (people, frames) of the pelvis since frame 0
  torch::Tensor swings;     ///< (people, frames, 2) 1 where the right, left foot is on its way
  torch::Tensor footholds;  ///< (people, frames, 2, 2) where toes stand or will, from the pelvis
  torch::Tensor foothold_known;  ///< (people, frames, 2) 0 where the recording ends before
  torch::Tensor mask;            ///< (people, frames) 1 where recorded

  int64_t frames() const { return joints.size(1); }
};

struct PosePaths {
  torch::Tensor joints;  ///< (people, frames, kBodyJoints, 3) from the pelvis, bones as in frame 0
  torch::Tensor height;  ///< (people, frames) of the pelvis since frame 0
  torch::Tensor swings;  ///< (people, frames, 2) logit of the right, left foot on its way
  torch::Tensor footholds;  ///< (people, frames, 2, 2) from the pelvis
};

/// From the path of a hip to the body around it: a recurrent network over the sequence, whose
/// joints are put back to each person's bone lengths.
class PoseNetImpl : public torch::nn::Module {
 public:
  explicit PoseNetImpl(const PoseConfig& config);

  PosePaths Forward(const PoseBatch& batch);

 private:
  PoseConfig config_;
  torch::nn::GRU cell_{nullptr};
  torch::nn::Linear pose_{nullptr};
};
TORCH_MODULE(PoseNet);

/// (people, frames, kPathSize): what the network sees of hips and leans.
torch::Tensor PathFeatures(const PoseBatch& batch, const PoseConfig& config);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TRAINING_POSE_NET_H_
