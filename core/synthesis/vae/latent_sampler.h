#ifndef POISE_CORE_SYNTHESIS_VAE_LATENT_SAMPLER_H_
#define POISE_CORE_SYNTHESIS_VAE_LATENT_SAMPLER_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/base/config_fields.h"
#include "core/base/random.h"
#include "core/base/status.h"

namespace poise::synthesis {

/// Where new latent vectors come from. Defaults are the paper's.
struct LatentSamplerConfig {
  /// near: around a few training motions of one cluster | pair: around any few | prior: N(0, I)
  std::string mode = "near";
  int clusters = 3;  ///< [> 0] n_c of k-means over the means (MotionAug sec. 4.1)
  int near = 2;      ///< [> 0] n_s motions that are averaged
  /// What is averaged beside the means: variance (paper) | deviation (the authors' program)
  std::string average = "variance";

  std::vector<base::Field> Fields();
};

/// Draws latent vectors: sampling-near-samples and what it is compared with.
/// Source: reference sec. 2.6. The motions are drawn without replacement (with, where a cluster has
/// fewer than `near`), clusters in proportion to their size; no PCA before k-means.
/// Constant after construction. Threads: any, each with its own Random.
class LatentSampler {
 public:
  /// What each training motion was encoded to. Shapes: (motions, latent), at least one motion.
  LatentSampler(Eigen::MatrixXd means, Eigen::MatrixXd variances, const LatentSamplerConfig& config,
                uint64_t seed);

  Eigen::VectorXd Draw(base::Random& random) const;

  const std::vector<std::vector<int>>& clusters() const { return clusters_; }

 private:
  std::vector<int> DrawMotions(base::Random& random) const;

  const Eigen::MatrixXd means_, variances_;
  const LatentSamplerConfig config_;
  std::vector<std::vector<int>> clusters_;  // motions of each
};

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_VAE_LATENT_SAMPLER_H_
