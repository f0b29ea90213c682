#include "core/math/k_means.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace poise::math {
namespace {

constexpr int kMaxIterations = 300;

struct Clustering {
  std::vector<int> labels;
  double cost = std::numeric_limits<double>::infinity();  // sum of squared distances
};

// Each next seed is drawn in proportion to the squared distance from those there are.
Eigen::MatrixXd SpreadSeeds(const Eigen::MatrixXd& points, int clusters, base::Random& random) {
  Eigen::MatrixXd centres(clusters, points.cols());
  Eigen::Index chosen = static_cast<Eigen::Index>(random.Index(points.rows()));
  Eigen::VectorXd nearest =
      Eigen::VectorXd::Constant(points.rows(), std::numeric_limits<double>::infinity());
  for (int k = 0; k < clusters; ++k) {
    centres.row(k) = points.row(chosen);
    nearest = nearest.cwiseMin((points.rowwise() - centres.row(k)).rowwise().squaredNorm());
    double left = random.Uniform() * nearest.sum();
    for (chosen = 0; chosen + 1 < points.rows(); ++chosen) {
      left -= nearest[chosen];
      if (left < 0) break;
    }
  }
  return centres;
}

Clustering Assign(const Eigen::MatrixXd& points, const Eigen::MatrixXd& centres) {
  Clustering clustering{.labels = std::vector<int>(points.rows()), .cost = 0};
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    Eigen::Index nearest = 0;
    clustering.cost +=
        (centres.rowwise() - points.row(i)).rowwise().squaredNorm().minCoeff(&nearest);
    clustering.labels[i] = static_cast<int>(nearest);
  }
  return clustering;
}

// The mean of each cluster; an empty one takes the point that is farthest from its own centre.
Eigen::MatrixXd Centres(const Eigen::MatrixXd& points, const std::vector<int>& labels,
                        const Eigen::MatrixXd& before) {
  Eigen::MatrixXd centres = Eigen::MatrixXd::Zero(before.rows(), before.cols());
  Eigen::VectorXd sizes = Eigen::VectorXd::Zero(before.rows());
  Eigen::VectorXd distances(points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    centres.row(labels[i]) += points.row(i);
    ++sizes[labels[i]];
    distances[i] = (points.row(i) - before.row(labels[i])).squaredNorm();
  }
  for (Eigen::Index k = 0; k < centres.rows(); ++k) {
    if (sizes[k] > 0) {
      centres.row(k) /= sizes[k];
      continue;
    }
    Eigen::Index farthest = 0;
    distances.maxCoeff(&farthest);
    centres.row(k) = points.row(farthest);
    distances[farthest] = -1;
  }
  return centres;
}

Clustering RunOnce(const Eigen::MatrixXd& points, int clusters, base::Random& random) {
  Eigen::MatrixXd centres = SpreadSeeds(points, clusters, random);
  Clustering clustering = Assign(points, centres);
  for (int i = 0; i < kMaxIterations; ++i) {
    centres = Centres(points, clustering.labels, centres);
    Clustering next = Assign(points, centres);
    const bool settled = next.labels == clustering.labels;
    clustering = std::move(next);
    if (settled) break;
  }
  return clustering;
}

// Points that coincide can leave clusters without any: the numbers in use become 0, 1, ...
std::vector<int> Renumbered(std::vector<int> labels) {
  std::vector<int> used(labels);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (int& label : labels) {
    label = static_cast<int>(std::lower_bound(used.begin(), used.end(), label) - used.begin());
  }
  return labels;
}

}  // namespace

std::vector<int> KMeans(const Eigen::MatrixXd& points, int clusters, base::Random& random,
                        int restarts) {
  if (points.rows() == 0) return {};
  clusters = static_cast<int>(std::min<Eigen::Index>(clusters, points.rows()));
  Clustering best;
  for (int i = 0; i < restarts; ++i) {
    Clustering clustering = RunOnce(points, clusters, random);
    if (clustering.cost < best.cost) best = std::move(clustering);
  }
  return Renumbered(std::move(best.labels));
}

}  // namespace poise::math
