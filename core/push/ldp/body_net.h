#ifndef POISE_CORE_PUSH_LDP_BODY_NET_H_
#define POISE_CORE_PUSH_LDP_BODY_NET_H_

#include <torch/torch.h>

#include <vector>

#include "core/push/ldp/body_rows.h"
#include "core/push/ldp/part_cvae.h"

namespace poise::push::ldp {

/// What bodies begin with and what moves them, one row a person.
struct BodyDrive {
  std::vector<torch::Tensor> first;  ///< FirstFeatures of each part: (people, FeatureCount)
  torch::Tensor pendulum;            ///< (people, frames, kPendulumFeatures), see PendulumFeatures
  torch::Tensor moves;  ///< (people, frames) 1 from the onset on; before it the pose stays
};

/// From pendulums to bodies: for each part a CVAE, and a sampler that chooses its latent from the
/// pendulum. Parts follow each other; a later one sees the positions that the first has in the next
/// frame. Features are normalised by statistics of the training rows, the same ones everywhere.
/// Source: reference sec. 7 to 9.
class BodyNetImpl : public torch::nn::Module {
 public:
  /// `pendulum` false: latents are drawn at random, without samplers.
  BodyNetImpl(const BodyConfig& config, bool pendulum);

  void SetStatistics(const BodyRows& rows);

  size_t num_parts() const { return parts_.size(); }
  const std::vector<std::vector<int>>& parts() const { return parts_; }
  PartCvae cvae(size_t part) { return cvaes_[part]; }
  LatentEncoder sampler(size_t part) { return samplers_[part]; }

  torch::Tensor NormalPart(size_t part, const torch::Tensor& rows) const;
  torch::Tensor RawPart(size_t part, const torch::Tensor& rows) const;
  torch::Tensor NormalPendulum(const torch::Tensor& rows) const;
  /// What a part's CVAE is told: its own features now and, for later parts, `first_next`, the first
  /// part's features in the next frame. Normalised.
  torch::Tensor Condition(size_t part, const torch::Tensor& now,
                          const torch::Tensor& first_next) const;

  /// Joints [m] from the hip of frame 0 (heights from the floor): (people, frames, kBodyJoints, 3).
  /// Gradients flow from each frame to its pendulum, not through the pose before it (as students
  /// are trained).
  torch::Tensor Rollout(const BodyDrive& drive);

 private:
  torch::Tensor Latent(size_t part, const torch::Tensor& pendulum, const torch::Tensor& condition);
  torch::Tensor Joints(const std::vector<torch::Tensor>& features) const;

  const BodyConfig config_;
  const bool pendulum_;
  const std::vector<std::vector<int>> parts_;
  std::vector<PartCvae> cvaes_;
  std::vector<LatentEncoder> samplers_;
  std::vector<torch::Tensor> mean_, deviation_;  // buffers, of each part
  torch::Tensor pendulum_mean_, pendulum_deviation_;
};
TORCH_MODULE(BodyNet);

}  // namespace poise::push::ldp

#endif  // POISE_CORE_PUSH_LDP_BODY_NET_H_
