#include "core/correction/reference_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/low_pass.h"
#include "core/math/slerp.h"
#include "core/physics/floor_alignment.h"

namespace poise::correction {
namespace {

using physics::kMaxBodies;
using physics::kMaxSpeeds;
using physics::SpeedIndex;
using physics::Speeds;
using physics::State;

// Central difference of two states `seconds` apart; in the layout of Speeds.
Speeds Difference(const State& before, const State& after, double seconds) {
  Speeds speeds;
  speeds.head<3>() = (after.root_position - before.root_position) / seconds;
  speeds.segment<3>(3) =
      math::ToRotationVector(after.rotations[0] * before.rotations[0].conjugate()) / seconds;
  for (int i = 1; i < kMaxBodies; ++i) {
    speeds.segment<3>(SpeedIndex(i)) =
        math::ToRotationVector(before.rotations[i].conjugate() * after.rotations[i]) / seconds;
  }
  return speeds;
}

void Filter(std::vector<Speeds>& rows, double rate_hz, double cutoff_hz) {
  std::vector<double> channel(rows.size());
  for (int k = 0; k < kMaxSpeeds; ++k) {
    for (size_t i = 0; i < rows.size(); ++i) channel[i] = rows[i][k];
    math::LowPassZeroPhase(channel, rate_hz, cutoff_hz);
    for (size_t i = 0; i < rows.size(); ++i) rows[i][k] = channel[i];
  }
}

// First frame after `from` at which the joint is where steady turning could have brought it, or -1.
int FrameBack(const std::vector<State>& frames, int joint, int from, int last, double most) {
  for (int frame = from + 2; frame <= last; ++frame) {
    const double turn =
        math::GeodesicDistance(frames[from].rotations[joint], frames[frame].rotations[joint]);
    if (turn <= std::min((frame - from) * most, 0.25 * std::numbers::pi)) return frame;
  }
  return -1;
}

void RepairFlips(std::vector<State>& frames, double frame_rate, const ReferenceConfig& config) {
  const double most = config.flip_speed / frame_rate;  // [rad] per frame
  const int window = static_cast<int>(config.flip_longest_s * frame_rate);
  const int last = static_cast<int>(frames.size()) - 1;
  for (int joint = 1; joint < kMaxBodies; ++joint) {
    for (int f = 0; f < last; ++f) {
      const Quat before = frames[f].rotations[joint];
      if (math::GeodesicDistance(before, frames[f + 1].rotations[joint]) <= most) continue;
      const int back = FrameBack(frames, joint, f, std::min(f + window, last), most);
      if (back < 0) continue;
      const Quat after = frames[back].rotations[joint];
      for (int k = f + 1; k < back; ++k) {
        const double u = static_cast<double>(k - f) / (back - f);
        frames[k].rotations[joint] = math::SlerpAt(u)(before, after);
      }
      f = back - 1;
    }
  }
}

}  // namespace

std::vector<base::Field> ReferenceConfig::Fields() {
  return {
      base::Number("velocity_cutoff_hz", &velocity_cutoff_hz, 0.1, 1000),
      base::Text("floor", &floor, {"lowest", "median", "none"}),
      base::Number("flip_speed", &flip_speed, 1, 1e6),
      base::Number("flip_longest_s", &flip_longest_s, 0, 10),
  };
}

StatusOr<ReferenceMotion> ReferenceMotion::Create(const motion::Clip& clip,
                                                  const physics::HumanoidModel& model,
                                                  const ReferenceConfig& config) {
  ReferenceConfig checked = config;
  POISE_RETURN_IF_ERROR(base::CheckRanges(checked.Fields()));
  if (clip.num_joints() != kMaxBodies) {
    return base::InvalidArgument("WRONG_SHAPE", "clip",
                                 fmt::format("clip '{}' has {} joints, the character {}",
                                             clip.name(), clip.num_joints(), kMaxBodies));
  }
  if (clip.num_frames() < 4) {
    return base::FailedPrecondition("CLIP_TOO_SHORT", "clip",
                                    fmt::format("clip '{}' has {} frames, expected at least 4",
                                                clip.name(), clip.num_frames()));
  }
  motion::Clip aligned = clip;
  if (config.floor != "none") {
    aligned = physics::AlignToFloor(
        std::move(aligned), model.shapes(),
        config.floor == "lowest" ? physics::FloorRule::kLowest : physics::FloorRule::kMedian);
  }
  ReferenceMotion motion(std::move(aligned));
  const int frames = motion.num_frames(), last = frames - 1;
  motion.frames_.resize(frames);
  for (int f = 0; f < frames; ++f) {
    motion.frames_[f].root_position = motion.clip_.root_position(f);
    std::ranges::copy(motion.clip_.pose(f), motion.frames_[f].rotations.begin());
  }
  RepairFlips(motion.frames_, motion.frame_rate(), config);
  const double step = 1 / motion.frame_rate();
  std::vector<Speeds> speeds(frames);
  for (int f = 0; f < frames; ++f) {
    const int a = std::max(f - 1, 0), b = std::min(f + 1, last);
    speeds[f] = Difference(motion.frames_[a], motion.frames_[b], (b - a) * step);
  }
  for (int i = 1; i < kMaxBodies; ++i) {
    if (!model.articulation().bodies[i].rigid_joint) continue;
    for (Speeds& row : speeds) row.segment<3>(SpeedIndex(i)).setZero();
  }
  Filter(speeds, motion.frame_rate(), config.velocity_cutoff_hz);
  for (int f = 0; f < frames; ++f) motion.frames_[f].speeds = speeds[f];
  for (int f = 0; f < frames; ++f) {
    const int a = std::max(f - 1, 0), b = std::min(f + 1, last);
    motion.accelerations_.push_back((speeds[b] - speeds[a]) / ((b - a) * step));
  }
  Filter(motion.accelerations_, motion.frame_rate(), config.velocity_cutoff_hz);
  return motion;
}

Speeds ReferenceMotion::AccelerationAt(double time_s) const {
  const double position = std::max(time_s * frame_rate(), 0.0);
  if (position >= num_frames() - 1) return Speeds::Zero();
  const int before = static_cast<int>(position);
  const double u = position - before;
  return (1 - u) * accelerations_[before] + u * accelerations_[before + 1];
}

State ReferenceMotion::At(double time_s) const {
  const double position = time_s * frame_rate();
  const int last = num_frames() - 1;
  if (position >= last) {
    State held = frames_[last];
    if (position > last) held.speeds.setZero();
    return held;
  }
  const int before = std::max(static_cast<int>(std::floor(position)), 0);
  const double u = std::max(position - before, 0.0);
  const State &a = frames_[before], &b = frames_[before + 1];
  if (u < 1e-9) return a;
  const math::SlerpAt between(u);
  State state;
  state.root_position = (1 - u) * a.root_position + u * b.root_position;
  for (int i = 0; i < kMaxBodies; ++i) {
    state.rotations[i] = between(a.rotations[i], b.rotations[i]);
  }
  state.speeds = (1 - u) * a.speeds + u * b.speeds;
  return state;
}

}  // namespace poise::correction
