#include "core/synthesis/vae/latent_sampler.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/math/k_means.h"

namespace poise::synthesis {
namespace {

constexpr int kMaxCount = 10'000;

std::vector<std::vector<int>> Clusters(const Eigen::MatrixXd& means,
                                       const LatentSamplerConfig& config, uint64_t seed) {
  std::vector<int> all(means.rows());
  std::iota(all.begin(), all.end(), 0);
  if (config.mode != "near") return {all};
  base::Random random(seed);
  const std::vector<int> labels = math::KMeans(means, config.clusters, random);
  std::vector<std::vector<int>> clusters(*std::max_element(labels.begin(), labels.end()) + 1);
  for (const int motion : all) clusters[labels[motion]].push_back(motion);
  return clusters;
}

}  // namespace

std::vector<base::Field> LatentSamplerConfig::Fields() {
  return {base::Text("mode", &mode, {"near", "pair", "prior"}),
          base::Number("clusters", &clusters, 1, kMaxCount),
          base::Number("near", &near, 1, kMaxCount),
          base::Text("average", &average, {"variance", "deviation"})};
}

LatentSampler::LatentSampler(Eigen::MatrixXd means, Eigen::MatrixXd variances,
                             const LatentSamplerConfig& config, uint64_t seed)
    : means_(std::move(means)),
      variances_(std::move(variances)),
      config_(config),
      clusters_(Clusters(means_, config_, seed)) {}

std::vector<int> LatentSampler::DrawMotions(base::Random& random) const {
  // A motion of all chooses its cluster: in proportion to the size.
  int64_t chosen = static_cast<int64_t>(random.Index(means_.rows()));
  size_t cluster = 0;
  while (chosen >= static_cast<int64_t>(clusters_[cluster].size())) {
    chosen -= static_cast<int64_t>(clusters_[cluster++].size());
  }
  std::vector<int> members = clusters_[cluster];
  std::vector<int> drawn;
  for (int i = 0; i < config_.near; ++i) {
    const size_t left = members.size() - (static_cast<int>(members.size()) >= config_.near ? i : 0);
    const size_t index = random.Index(left);
    drawn.push_back(members[index]);
    // Behind the rest: not drawn again where there are enough.
    std::swap(members[index], members[left - 1]);
  }
  return drawn;
}

Eigen::VectorXd LatentSampler::Draw(base::Random& random) const {
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(means_.cols());
  Eigen::VectorXd deviation = Eigen::VectorXd::Ones(means_.cols());
  if (config_.mode != "prior") {
    const std::vector<int> motions = DrawMotions(random);
    const double share = 1.0 / static_cast<double>(motions.size());
    Eigen::VectorXd spread = Eigen::VectorXd::Zero(means_.cols());
    for (const int motion : motions) {
      mean += share * means_.row(motion).transpose();
      const Eigen::VectorXd variance = variances_.row(motion).transpose();
      spread += share * (config_.average == "variance" ? variance : variance.cwiseSqrt());
    }
    deviation = config_.average == "variance" ? spread.cwiseSqrt().eval() : spread;
  }
  for (Eigen::Index i = 0; i < mean.size(); ++i) mean[i] += deviation[i] * random.Normal();
  return mean;
}

}  // namespace poise::synthesis
