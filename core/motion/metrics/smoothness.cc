#include "core/motion/metrics/smoothness.h"

#include <array>
#include <cmath>

namespace poise::motion {
namespace {

// RMS length of the finite difference with these weights on consecutive frames.
template <size_t N>
double DifferenceRms(const WorldPoses& world, const std::array<double, N>& weights) {
  const int differences = world.num_frames - static_cast<int>(N) + 1;
  const size_t row = static_cast<size_t>(world.num_joints) * 3;
  const double* positions = world.positions.data()->data();
  double sum = 0;
  for (int frame = 0; frame < differences; ++frame) {
    const double* first = positions + frame * row;
    for (size_t i = 0; i < row; ++i) {
      double difference = 0;
      for (size_t k = 0; k < N; ++k) difference += weights[k] * first[k * row + i];
      sum += difference * difference;
    }
  }
  return std::sqrt(sum / differences / world.num_joints);
}

}  // namespace

double AccelerationRms(const WorldPoses& world, double frame_rate) {
  return DifferenceRms(world, std::array{1.0, -2.0, 1.0}) * std::pow(frame_rate, 2);
}

double JerkRms(const WorldPoses& world, double frame_rate) {
  return DifferenceRms(world, std::array{-1.0, 3.0, -3.0, 1.0}) * std::pow(frame_rate, 3);
}

}  // namespace poise::motion
