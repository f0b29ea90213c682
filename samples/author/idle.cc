#include "samples/author/idle.h"

#include <cmath>
#include <utility>

namespace poise::samples {

VectorChannel WithIdle(VectorChannel channel, double amplitude, double phase) {
  return [channel = std::move(channel), amplitude, phase](double time) -> math::Vec3 {
    // Two slow waves an axis, in no simple ratio, so that nothing repeats within a clip.
    const math::Vec3 drift(std::sin(2.9 * time + phase) + 0.5 * std::sin(5.3 * time + 2 * phase),
                           std::sin(3.7 * time + phase + 1) + 0.4 * std::sin(6.1 * time + phase),
                           std::sin(2.3 * time + phase + 2) + 0.5 * std::sin(4.7 * time - phase));
    return channel(time) + amplitude * drift;
  };
}

}  // namespace poise::samples
