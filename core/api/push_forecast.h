#ifndef POISE_CORE_API_PUSH_FORECAST_H_
#define POISE_CORE_API_PUSH_FORECAST_H_

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/skeleton.h"

namespace poise::api {

/// Who is in a forecast: its first message.
struct PushForecastPerson {
  std::string id;
  double mass_kg = 0;
  motion::SkeletonPtr skeleton;
};

struct PushForecastScene {
  std::string model;
  double frame_rate = 0;
  int frames = 0;
  std::vector<PushForecastPerson> people;
};

/// One person in one frame. World frame, Y up, but for pendulum and forces: those are in the ground
/// frame of core/push (X as in the world, Y = -z, Z up).
struct PushPersonFrame {
  motion::Vec3 root_position = motion::Vec3::Zero();
  std::vector<motion::Quat> rotations;  ///< (joints)
  std::array<double, 4> pendulum{};     ///< x, y [m], theta, phi [rad]
  std::array<double, 4> pendulum_rate{};
  double rod_m = 0;
  motion::Vec3 hip = motion::Vec3::Zero();    ///< end of the rod [m]
  std::array<double, 4> interaction_force{};  ///< from others: Fx, Fy [N], Ftheta, Fphi [N m]
  std::optional<double> onset_s;              ///< of the first movement, once it has begun
};

struct PushForecastFrame {
  int index = 0;
  double time_s = 0;
  std::vector<PushPersonFrame> people;
};

}  // namespace poise::api

#endif  // POISE_CORE_API_PUSH_FORECAST_H_
