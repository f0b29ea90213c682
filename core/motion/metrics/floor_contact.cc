#include "core/motion/metrics/floor_contact.h"

#include <algorithm>
#include <cmath>

namespace poise::motion {
namespace {

constexpr double kLowQuantile = 0.05;

// The lowest corner of one sole in one frame, and how it moves.
struct SolePoint {
  double height;
  double horizontal_speed;
  double speed;
};

// One point per foot and inner frame: speeds are central differences.
std::vector<SolePoint> LowestSolePoints(const PlacedBodies& bodies, double frame_rate) {
  std::vector<SolePoint> points;
  points.reserve(static_cast<size_t>(bodies.num_frames) * PlacedBodies::kFeet);
  for (int frame = 1; frame + 1 < bodies.num_frames; ++frame) {
    for (int foot = 0; foot < PlacedBodies::kFeet; ++foot) {
      int lowest = 0;
      for (int corner = 1; corner < PlacedBodies::kCorners; ++corner) {
        if (bodies.corner(frame, foot, corner).y() < bodies.corner(frame, foot, lowest).y()) {
          lowest = corner;
        }
      }
      const Vec3 velocity =
          (bodies.corner(frame + 1, foot, lowest) - bodies.corner(frame - 1, foot, lowest)) *
          (frame_rate / 2);
      points.push_back({bodies.corner(frame, foot, lowest).y(),
                        std::hypot(velocity.x(), velocity.z()), velocity.norm()});
    }
  }
  return points;
}

double Quantile(std::vector<double>& values, double fraction) {
  const auto at = values.begin() + static_cast<ptrdiff_t>(fraction * (values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double EstimateFloor(const std::vector<SolePoint>& points, const PlausibilityConfig& config) {
  std::vector<double> heights;
  for (size_t i = 0; i + 1 < points.size(); i += PlacedBodies::kFeet) {
    heights.push_back(std::min(points[i].height, points[i + 1].height));
  }
  const double low = Quantile(heights, kLowQuantile);
  std::vector<double> still;
  for (const SolePoint& point : points) {
    if (point.speed < config.still_speed_mps && point.height < low + config.floor_band_m) {
      still.push_back(point.height);
    }
  }
  return still.empty() ? low : Quantile(still, 0.5);
}

double FootSkate(const std::vector<SolePoint>& points, double floor, double contact_height) {
  double sum = 0, weights = 0;
  for (const SolePoint& point : points) {
    const double height = (point.height - floor) / contact_height;
    if (height >= 1) continue;
    const double weight = 2 - std::exp2(std::max(height, 0.0));
    sum += weight * point.horizontal_speed;
    weights += weight;
  }
  return weights > 0 ? sum / weights : 0;
}

FloorContact Against(const PlacedBodies& bodies, const std::vector<SolePoint>& points,
                     double floor_height_m, const PlausibilityConfig& config) {
  FloorContact contact;
  contact.floor_height_m = floor_height_m;
  contact.foot_skate_mps = FootSkate(points, floor_height_m, config.contact_height_m);
  for (const double lowest : bodies.lowest) {
    const double depth = floor_height_m - lowest;
    contact.penetration_mean_m += std::max(depth, 0.0);
    contact.penetration_max_m = std::max(contact.penetration_max_m, depth);
    contact.float_mean_m += std::max(-depth, 0.0);
  }
  contact.penetration_mean_m /= bodies.num_frames;
  contact.float_mean_m /= bodies.num_frames;
  return contact;
}

}  // namespace

FloorContact MeasureFloorContact(const PlacedBodies& bodies, double frame_rate,
                                 const PlausibilityConfig& config) {
  const std::vector<SolePoint> points = LowestSolePoints(bodies, frame_rate);
  return Against(bodies, points, EstimateFloor(points, config), config);
}

FloorContact MeasureContactWithFloor(const PlacedBodies& bodies, double frame_rate,
                                     double floor_height_m, const PlausibilityConfig& config) {
  return Against(bodies, LowestSolePoints(bodies, frame_rate), floor_height_m, config);
}

}  // namespace poise::motion
