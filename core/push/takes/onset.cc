#include "core/push/takes/onset.h"

#include <cmath>

namespace poise::push {

int RecordedOnset(const TakePerson& person, bool pushed) {
  constexpr double kMovingSpeed = 0.1;  // [m/s]
  if (pushed) return 0;
  const int frames = person.frames();
  for (int frame = 0; frame + 1 < frames; ++frame) {
    const double step = person.joint(frame + 1, kPelvis).x() - person.joint(frame, kPelvis).x();
    if (std::abs(step) * kFrameRate >= kMovingSpeed) return frame;
  }
  return -1;
}

}  // namespace poise::push
