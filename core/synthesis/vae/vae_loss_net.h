#ifndef POISE_CORE_SYNTHESIS_VAE_VAE_LOSS_NET_H_
#define POISE_CORE_SYNTHESIS_VAE_VAE_LOSS_NET_H_

#include <torch/torch.h>

#include "core/synthesis/vae/vae_net.h"

/// The terms of the VAE's losses, each a scalar without its weight. `valid` (batch, frames) is 1
/// where a frame counts: a term is the mean over a motion's valid frames, then over the batch.
/// Source: reference sec. 2.4.
namespace poise::synthesis {

/// Poses as positions and rotation matrices.
struct DecodedPoses {
  torch::Tensor positions;  // (batch, frames, 3), in the unit of the columns
  torch::Tensor rotations;  // (batch, frames, joints, 3, 3)
};

/// poses (batch, frames, 3 + joints * 6): a 6D rotation is two columns that need not be
/// orthonormal (Gram-Schmidt; Zhou et al. 2019).
DecodedPoses DecodeColumns(const torch::Tensor& poses);

/// |p_x - p_y|^2 + sum over joints of |R_x - R_y|^2 (Frobenius).
torch::Tensor ReconstructionLoss(const DecodedPoses& x, const DecodedPoses& y,
                                 const torch::Tensor& valid);

/// The same of second differences in time of y alone; zero for motions of under three frames.
torch::Tensor SmoothnessLoss(const DecodedPoses& y, const torch::Tensor& valid);

/// Kullback-Leibler divergence from N(0, I), summed over the latent dimensions.
torch::Tensor KlLoss(const LatentGaussian& gaussian);

/// Squared error, motion by motion. (The authors' program subtracts a column from a row and so
/// pulls every prediction to the average length.)
torch::Tensor LengthLoss(const torch::Tensor& predicted, const torch::Tensor& lengths);

/// What a discriminator wants: verdicts above 1 on real motions, below -1 on made ones (hinge).
torch::Tensor DiscriminatorLoss(const torch::Tensor& real, const torch::Tensor& made);

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_VAE_VAE_LOSS_NET_H_
