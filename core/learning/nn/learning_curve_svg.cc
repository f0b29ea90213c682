// The picture of a learning curve.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/learning/nn/learning_curve.h"

namespace poise::learning {
namespace {

using Points = std::vector<std::pair<double, double>>;  // step, value

// One chart [px]; labels stand inside its margins.
constexpr double kWidth = 420, kHeight = 200, kLeft = 64, kRight = 12, kTop = 26, kBottom = 24;
constexpr int kColumns = 2;
constexpr double kTitleHeight = 30;

// Maps [low, high] to pixels; in decades where that shows more.
struct Axis {
  double low, high, first_px, last_px;
  bool logarithmic = false;

  double Place(double value) const {
    const auto scale = [&](double x) { return logarithmic ? std::log10(x) : x; };
    const double span = scale(high) - scale(low);
    const double part = span > 0 ? (scale(value) - scale(low)) / span : 0.5;
    return first_px + part * (last_px - first_px);
  }
};

std::string Text(double x, double y, std::string_view anchor, std::string_view text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     text);
}

std::string Chart(std::string_view name, const Points& points, double left, double top) {
  double low = INFINITY, high = -INFINITY;
  for (const auto& [step, value] : points) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  const Axis across{.low = points.front().first,
                    .high = points.back().first,
                    .first_px = left + kLeft,
                    .last_px = left + kWidth - kRight};
  const Axis up{.low = low,
                .high = high,
                .first_px = top + kHeight - kBottom,
                .last_px = top + kTop,
                .logarithmic = low > 0 && high > 10 * low};
  std::string line;
  for (const auto& [step, value] : points) {
    line += fmt::format("{:.1f},{:.1f} ", across.Place(step), up.Place(value));
  }
  std::string svg = fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
      "stroke=\"#bbb\"/>\n<polyline fill=\"none\" stroke=\"#1f6fb4\" stroke-width=\"1.5\" "
      "points=\"{}\"/>\n",
      across.first_px, up.last_px, across.last_px - across.first_px, up.first_px - up.last_px,
      line);
  svg += Text(
      across.first_px, up.last_px - 8, "start",
      fmt::format("{}{}: last {:.4g}", name, up.logarithmic ? " (log)" : "", points.back().second));
  svg += Text(across.first_px - 4, up.first_px, "end", fmt::format("{:.3g}", low));
  svg += Text(across.first_px - 4, up.last_px + 10, "end", fmt::format("{:.3g}", high));
  svg += Text(across.first_px, up.first_px + 16, "start", fmt::format("{}", across.low));
  svg += Text(across.last_px, up.first_px + 16, "end", fmt::format("step {}", across.high));
  return svg;
}

std::string Escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

}  // namespace

std::string LearningCurve::ToSvg(std::string_view title) const {
  std::string charts;
  int count = 0;
  for (const std::string& name : Names()) {
    Points points;
    for (const Row& row : rows_) {
      const auto found = row.values.find(name);
      if (found != row.values.end() && std::isfinite(found->second)) {
        points.emplace_back(static_cast<double>(row.step), found->second);
      }
    }
    if (points.empty()) continue;
    charts += Chart(Escaped(name), points, count % kColumns * kWidth,
                    kTitleHeight + count / kColumns * kHeight);
    ++count;
  }
  const int rows = (count + kColumns - 1) / kColumns;
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"11\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
      "<text x=\"12\" y=\"20\" font-size=\"14\">{}</text>\n{}</svg>\n",
      kColumns * kWidth, kTitleHeight + rows * kHeight, Escaped(title), charts);
}

}  // namespace poise::learning
