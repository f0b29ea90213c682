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
    const Eigen::Vector2d recorded = take.force[frame].head<2>();
    switch (protocol) {
      case Protocol::kA:
        input.force_n.push_back(recorded);
        break;
      case Protocol::kB:
        input.force_n.push_back(ForceInFrame(half_sine, frame));
        break;
      case Protocol::kC:
        input.force_n.push_back(frame == 0
                                    ? Eigen::Vector2d::Zero()
                                    : Eigen::Vector2d(recorded * (1 + kNoise * random.Normal())));
        break;
    }
  }
  return input;
}

}  // namespace poise::push
