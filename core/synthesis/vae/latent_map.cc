#include "core/synthesis/vae/latent_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/math/principal_axes.h"

namespace poise::synthesis {
namespace {

constexpr double kSize = 480, kMargin = 40;  // [px]
constexpr std::array<const char*, 6> kColours = {"#1f6fb4", "#d1495b", "#2e8b57",
                                                 "#e09f3e", "#6a4c93", "#7a7a7a"};

// From the plane of the axes to pixels, the same scale both ways.
struct Frame {
  Eigen::Vector2d centre;
  double px_per_unit;

  Eigen::Vector2d Place(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d offset = px_per_unit * (point - centre);
    return {kSize / 2 + offset.x(), kSize / 2 - offset.y()};
  }
};

Frame FrameOf(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::Vector2d low = a.colwise().minCoeff().transpose(), high = a.colwise().maxCoeff();
  if (b.rows() > 0) {
    low = low.cwiseMin(b.colwise().minCoeff().transpose());
    high = high.cwiseMax(b.colwise().maxCoeff().transpose());
  }
  const double extent = std::max((high - low).maxCoeff(), 1e-9);
  return {(low + high) / 2, (kSize - 2 * kMargin) / extent};
}

std::string Circle(const Eigen::Vector2d& at, double radius, const std::string& style) {
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" {}/>\n", at.x(), at.y(), radius,
                     style);
}

std::string Text(double x, double y, const std::string& text) {
  return fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\">{}</text>\n", x, y, text);
}

}  // namespace

std::string LatentMap(const Eigen::MatrixXd& training,
                      const std::vector<std::vector<int>>& clusters,
                      const Eigen::MatrixXd& samples) {
  const math::PrincipalAxes axes = math::FindPrincipalAxes(training, 2);
  const Eigen::MatrixXd from = axes.Project(training);
  const Eigen::MatrixXd made = axes.Project(samples);
  const Frame frame = FrameOf(from, made);
  std::string svg;
  for (Eigen::Index i = 0; i < made.rows(); ++i) {
    svg += Circle(frame.Place(made.row(i).transpose()), 2.5, "fill=\"none\" stroke=\"#999\"");
  }
  for (size_t k = 0; k < clusters.size(); ++k) {
    const std::string style = fmt::format("fill=\"{}\"", kColours[k % kColours.size()]);
    for (const int motion : clusters[k]) {
      svg += Circle(frame.Place(from.row(motion).transpose()), 4.5, style);
    }
  }
  const double share =
      axes.total_variance > 0 ? 100 * axes.variances.sum() / axes.total_variance : 100;
  svg += Text(12, 20,
              fmt::format("{} training motions in {} clusters, {} samples", training.rows(),
                          clusters.size(), samples.rows()));
  svg += Text(12, kSize - 10,
              fmt::format("two principal axes: {:.0f} % of the variance of the motions", share));
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{0:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"11\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{1}</svg>\n",
      kSize, svg);
}

}  // namespace poise::synthesis
