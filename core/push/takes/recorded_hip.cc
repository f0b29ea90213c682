#include "core/push/takes/recorded_hip.h"

namespace poise::push {

std::vector<Eigen::Vector2d> RecordedHip(const TakePerson& person, int64_t frames) {
  constexpr double kSlowing = 0.9;  // of the last speed, a frame
  std::vector<Eigen::Vector2d> path;
  Eigen::Vector2d place = Eigen::Vector2d::Zero(), speed = Eigen::Vector2d::Zero();
  for (int frame = 0; frame < frames; ++frame) {
    if (frame < person.frames()) {
      const Vec3 moved = person.joint(frame, kPelvis) - person.joint(0, kPelvis);
      speed = moved.head<2>() - place;
      place = moved.head<2>();
    } else {
      speed *= kSlowing;
      place += speed;
    }
    path.push_back(place);
  }
  return path;
}

}  // namespace poise::push
