#include "core/push/takes/push_protocol.h"

#include <fmt/format.h>

#include "core/push/push_scene.h"

namespace poise::push {

StatusOr<Protocol> ParseProtocol(std::string_view name) {
  if (name == "A") return Protocol::kA;
  if (name == "B") return Protocol::kB;
  if (name == "C") return Protocol::kC;
  return base::InvalidArgument("UNKNOWN_PROTOCOL", "protocol",
                               fmt::format("protocol '{}', expected A, B or C", name));
}

PushInput InputOf(const PushTake& take, Protocol protocol, base::Random& random) {
  constexpr double kNoise = 0.1;
  PushInput input;
  for (int frame = 1; frame < take.push_frames; ++frame) {
    input.impulse_ns += take.force[frame][0] * kFrameTime;
  }
  ScenePush half_sine{.frames = take.push_frames};
  half_sine.force_n = {input.impulse_ns * kFrameRate / take.push_frames, 0};
  for (int frame = 0; frame < take.push_frames; ++frame) {
    if (protocol == Protocol::kB) {
      input.force_n.push_back(ForceInFrame(half_sine, frame));
      continue;
    }
    GeneralisedForce told = take.force[frame];
    if (protocol == Protocol::kC) told *= frame == 0 ? 0 : 1 + kNoise * random.Normal();
    input.generalised.push_back(told);
    input.force_n.push_back(told.head<2>());
  }
  return input;
}

}  // namespace poise::push
