#include "core/motion/editing/sample_at.h"

#include <fmt/format.h>

#include <cmath>

#include "core/math/slerp.h"

namespace poise::motion {
namespace {

constexpr double kOnFrame = 1e-6;

}  // namespace

StatusOr<Clip> SampleAt(const Clip& clip, std::span<const double> places, double frame_rate) {
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
  rotations.reserve(places.size() * clip.num_joints());
  for (const double place : places) {
    const double nearest = std::round(place);
    const bool on_frame = std::abs(place - nearest) < kOnFrame;
    const double before = on_frame ? nearest : std::floor(place);
    const double after = on_frame ? nearest : before + 1;
    if (!(before >= 0 && after <= clip.num_frames() - 1)) {
      return base::InvalidArgument("BAD_FRAME_RANGE", "places",
                                   fmt::format("clip '{}' has {} frames, wanted a pose at {}",
                                               clip.name(), clip.num_frames(), place));
    }
    const int a = static_cast<int>(before), b = static_cast<int>(after);
    const double u = on_frame ? 0 : place - before;
    positions.push_back(on_frame
                            ? clip.root_position(a)
                            : Vec3((1 - u) * clip.root_position(a) + u * clip.root_position(b)));
    const math::SlerpAt slerp(u);
    for (int joint = 0; joint < clip.num_joints(); ++joint) {
      rotations.push_back(slerp(clip.rotation(a, joint), clip.rotation(b, joint)));
    }
  }
  return Clip::Create(clip.name(), clip.skeleton(), frame_rate, std::move(positions),
                      std::move(rotations));
}

}  // namespace poise::motion
