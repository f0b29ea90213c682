#include "core/push/interaction/body_contact.h"

#include <algorithm>
#include <cmath>

namespace poise::push {
namespace {

bool Before(const Pair& a, const Pair& b) {
  return a.first != b.first ? a.first < b.first : a.second < b.second;
}

// 1 at `near`, 0 at `far`, smooth between.
double Fade(double distance, double near, double far) {
  const double t = std::clamp((far - distance) / (far - near), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

BodyContact::BodyContact(const PhysicsConfig& config, const Eigen::ArrayX2d& hips)
    : config_(config) {
  NeighbourPairs neighbours;
  for (const Pair& pair : neighbours.Find(hips, 2 * config.body_radius_m)) {
    close_.push_back(pair);
    distance_.push_back((hips.row(pair.first) - hips.row(pair.second)).matrix().norm());
  }
}

double BodyContact::range() const { return std::max(2 * config_.body_radius_m, config_.reach_m); }

double BodyContact::RestDistance(const Pair& pair) const {
  const auto found = std::lower_bound(close_.begin(), close_.end(), pair, Before);
  if (found == close_.end() || Before(pair, *found)) return 2 * config_.body_radius_m;
  return distance_[found - close_.begin()];
}

void BodyContact::AddForces(const std::vector<Pair>& pairs, const Eigen::ArrayX2d& hips,
                            const Eigen::ArrayX2d& velocities, Eigen::ArrayX2d& force) const {
  constexpr double kCoincident = 1e-9;  // [m] no direction to push apart
  for (const Pair& pair : pairs) {
    const Eigen::Array2d between = (hips.row(pair.first) - hips.row(pair.second)).transpose();
    const double distance = between.matrix().norm();
    if (distance < kCoincident) continue;
    const Eigen::Array2d apart = between / distance;
    const double nearing =
        -((velocities.row(pair.first) - velocities.row(pair.second)).transpose() * apart).sum();
    const double rest = RestDistance(pair);
    double push = config_.contact_stiffness * std::max(0.0, rest - distance);
    push += config_.reach_damping * std::max(0.0, nearing) *
            Fade(distance, rest, std::max(rest + 1e-3, config_.reach_m));
    force.row(pair.first) += push * apart.transpose();
    force.row(pair.second) -= push * apart.transpose();
  }
}

}  // namespace poise::push
