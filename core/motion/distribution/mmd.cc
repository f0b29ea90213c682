#include "core/motion/distribution/mmd.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace poise::motion {
namespace {

constexpr int kGaussians = 5;
constexpr double kNarrowest = 0.25;  // of the mean squared distance
constexpr int kMaxRepetitions = 1'000'000;

// A pair of samples as the kernel of all its points; x's come first.
struct KernelMatrix {
  Eigen::MatrixXd values;
  Eigen::Index num_x = 0;
};

Eigen::MatrixXd SquaredDistances(const Eigen::MatrixXd& points) {
  Eigen::MatrixXd distances(points.rows(), points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    distances.col(i) = (points.rowwise() - points.row(i)).rowwise().squaredNorm();
  }
  return distances;
}

KernelMatrix MakeKernel(const SamplePair& pair) {
  Eigen::MatrixXd points(pair.x.rows() + pair.y.rows(), pair.x.cols());
  points << pair.x, pair.y;
  const Eigen::MatrixXd distances = SquaredDistances(points);
  const double count = static_cast<double>(points.rows());
  const double mean = distances.sum() / (count * (count - 1));
  KernelMatrix kernel{Eigen::MatrixXd::Zero(points.rows(), points.rows()), pair.x.rows()};
  for (int i = 0; i < kGaussians; ++i) {
    // All points in one place: nothing to tell apart.
    const double width = mean > 0 ? mean * kNarrowest * (1 << i) : 1;
    kernel.values.array() += (-distances.array() / width).exp();
  }
  return kernel;
}

// `order`: which points are x's, then which are y's.
double SquaredMmd(const KernelMatrix& kernel, const std::vector<int>& order, bool unbiased) {
  const Eigen::Index n = kernel.values.rows(), nx = kernel.num_x, ny = n - nx;
  Eigen::VectorXd is_x = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < nx; ++i) is_x[order[i]] = 1;
  const Eigen::VectorXd is_y = 1 - is_x.array();
  const Eigen::VectorXd to_x = kernel.values * is_x;
  double within_x = to_x.dot(is_x), across = to_x.dot(is_y);
  double within_y = kernel.values.sum() - within_x - 2 * across;
  const double x = static_cast<double>(nx), y = static_cast<double>(ny);
  double pairs_x = x * x, pairs_y = y * y;
  if (unbiased) {  // a point's kernel with itself is the number of Gaussians
    within_x -= kGaussians * x;
    within_y -= kGaussians * y;
    pairs_x -= x;
    pairs_y -= y;
  }
  return within_x / pairs_x + within_y / pairs_y - 2 * across / (x * y);
}

Status Check(std::span<const SamplePair> pairs) {
  if (pairs.empty()) {
    return base::InvalidArgument("TOO_FEW_SAMPLES", "pairs", "there is nothing to compare");
  }
  for (const SamplePair& pair : pairs) {
    if (pair.x.rows() < 2 || pair.y.rows() < 2) {
      return base::InvalidArgument(
          "TOO_FEW_SAMPLES", "pairs",
          fmt::format("two samples are compared by at least 2 points each, not {} and {}",
                      pair.x.rows(), pair.y.rows()));
    }
    if (pair.x.cols() != pair.y.cols()) {
      return base::InvalidArgument(
          "WRONG_SHAPE", "pairs",
          fmt::format("points of {} and {} features", pair.x.cols(), pair.y.cols()));
    }
  }
  return absl::OkStatus();
}

void Shuffle(std::vector<int>& order, base::Random& random) {
  for (size_t i = order.size() - 1; i > 0; --i) std::swap(order[i], order[random.Index(i + 1)]);
}

bool IsUnequal(const SamplePair& pair) { return pair.x.rows() > pair.y.rows(); }

SamplePair DrawEqual(const SamplePair& pair, base::Random& random) {
  std::vector<int> order(pair.x.rows());
  std::iota(order.begin(), order.end(), 0);
  Shuffle(order, random);
  order.resize(std::min(pair.x.rows(), pair.y.rows()));
  return {pair.x(order, Eigen::all), pair.y};
}

MmdResult Discrepancy(std::span<const SamplePair> pairs, const MmdConfig& config,
                      base::Random& random) {
  std::vector<KernelMatrix> kernels;
  std::vector<std::vector<int>> orders;
  for (const SamplePair& pair : pairs) {
    kernels.push_back(MakeKernel(pair));
    orders.emplace_back(kernels.back().values.rows());
    std::iota(orders.back().begin(), orders.back().end(), 0);
  }
  const auto pooled = [&] {
    double sum = 0;
    for (size_t i = 0; i < kernels.size(); ++i) {
      sum += SquaredMmd(kernels[i], orders[i], config.estimator == "unbiased");
    }
    return sum / static_cast<double>(kernels.size());
  };
  MmdResult result{.squared_mmd = pooled()};
  int as_far = 1;
  for (int i = 0; i < config.permutations; ++i) {
    for (std::vector<int>& order : orders) Shuffle(order, random);
    if (pooled() >= result.squared_mmd) ++as_far;
  }
  if (config.permutations > 0) {
    result.p_value = static_cast<double>(as_far) / (config.permutations + 1);
  }
  return result;
}

}  // namespace

std::vector<base::Field> MmdConfig::Fields() {
  return {base::Text("estimator", &estimator, {"unbiased", "biased"}),
          base::Number("permutations", &permutations, 0, kMaxRepetitions),
          base::Number("draws", &draws, 1, kMaxRepetitions)};
}

StatusOr<MmdResult> MaximumMeanDiscrepancy(std::span<const SamplePair> pairs,
                                           const MmdConfig& config, base::Random& random) {
  MmdConfig copy = config;
  POISE_RETURN_IF_ERROR(base::CheckRanges(copy.Fields()));
  POISE_RETURN_IF_ERROR(Check(pairs));
  if (std::none_of(pairs.begin(), pairs.end(), IsUnequal)) {
    return Discrepancy(pairs, config, random);
  }
  MmdResult mean{.squared_mmd = 0, .p_value = 0};
  for (int i = 0; i < config.draws; ++i) {
    std::vector<SamplePair> drawn;
    for (const SamplePair& pair : pairs) drawn.push_back(DrawEqual(pair, random));
    const MmdResult result = Discrepancy(drawn, config, random);
    mean.squared_mmd += result.squared_mmd / config.draws;
    mean.p_value += result.p_value / config.draws;
  }
  return mean;
}

}  // namespace poise::motion
