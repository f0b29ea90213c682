#ifndef POISE_CORE_SYNTHESIS_VAE_VAE_TENSORS_NET_H_
#define POISE_CORE_SYNTHESIS_VAE_VAE_TENSORS_NET_H_

#include <torch/torch.h>

#include <vector>

#include "core/motion/pose_codec.h"
#include "core/synthesis/vae/vae_motions.h"

/// Motions on their way into tensors and back.
namespace poise::synthesis {

/// Motions side by side, each brought to the same length by repeating its last pose.
struct MotionBatch {
  torch::Tensor poses;    // (motions, frames, width) float
  torch::Tensor lengths;  // (motions) int64
};

/// Longer motions are cut. Precondition: at least one motion.
MotionBatch StackMotions(const std::vector<const motion::PoseMatrix*>& motions, int frames,
                         const RootScale& root);

/// The first `length` frames of poses (frames, width), with the root in metres again.
motion::PoseMatrix UnstackMotion(const torch::Tensor& poses, int length, const RootScale& root);

/// Mean geodesic angle between the rotations of two batches over joints and valid frames [rad], and
/// mean distance of the roots [m].
struct PoseError {
  double rotation_rad = 0;
  double root_m = 0;
};
PoseError CompareMotions(const torch::Tensor& x, const torch::Tensor& y,
                         const torch::Tensor& lengths, const RootScale& root);

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_VAE_VAE_TENSORS_NET_H_
