#ifndef POISE_CORE_MATH_K_MEANS_H_
#define POISE_CORE_MATH_K_MEANS_H_

#include <Eigen/Core>
#include <vector>

#include "core/base/random.h"

namespace poise::math {

/// Which cluster each point belongs to, 0 .. clusters - 1; no cluster is empty.
/// Lloyd's algorithm from seeds that are far apart (k-means++, Arthur and Vassilvitskii 2007), the
/// best of `restarts` by the sum of squared distances. Same state of `random`, same clusters.
/// Shapes: points (points, dimensions). Precondition: 1 <= clusters; fewer points than clusters
/// give as many clusters as points.
std::vector<int> KMeans(const Eigen::MatrixXd& points, int clusters, base::Random& random,
                        int restarts = 10);

}  // namespace poise::math

#endif  // POISE_CORE_MATH_K_MEANS_H_
