#include "core/correction/reference_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/correction/preparation/foot_track.h"
#include "core/correction/preparation/preparation.h"
#include "core/math/low_pass.h"
#include "core/math/slerp.h"
#include "core/motion/metrics/floor_contact.h"
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
int FrameBack(const motion::Clip& clip, int joint, int from, int last, double most) {
  for (int frame = from + 2; frame <= last; ++frame) {
    const double turn =
        math::GeodesicDistance(clip.rotation(from, joint), clip.rotation(frame, joint));
    if (turn <= std::min((frame - from) * most, 0.25 * std::numbers::pi)) return frame;
  }
  return -1;
}

void RepairFlips(const ReferenceConfig& config, motion::Clip& clip) {
  const double most = config.flip_speed / clip.frame_rate();  // [rad] per frame
  const int window = static_cast<int>(config.flip_longest_s * clip.frame_rate());
  const int last = clip.num_frames() - 1;
  for (int joint = 1; joint < kMaxBodies; ++joint) {
    for (int f = 0; f < last; ++f) {
      const Quat before = clip.rotation(f, joint);
      if (math::GeodesicDistance(before, clip.rotation(f + 1, joint)) <= most) continue;
      const int back = FrameBack(clip, joint, f, std::min(f + window, last), most);
      if (back < 0) continue;
      const Quat after = clip.rotation(back, joint);
      for (int k = f + 1; k < back; ++k) {
        const double u = static_cast<double>(k - f) / (back - f);
        clip.rotation(k, joint) = math::SlerpAt(u)(before, after);
      }
      f = back - 1;
    }
  }
}

motion::Clip PutOnFloor(motion::Clip clip, const physics::HumanoidModel& model,
                        const std::string& rule) {
  using physics::FloorRule;
  if (rule == "none") return clip;
  if (rule != "still") {
    return physics::AlignToFloor(std::move(clip), model.shapes(),
                                 rule == "lowest" ? FloorRule::kLowest : FloorRule::kMedian);
  }
  motion::PlacedBodies bodies;
  motion::PlaceBodies(model.shapes(), motion::ForwardKinematics(clip), bodies);
  const double floor = motion::MeasureFloorContact(bodies, clip.frame_rate(), {}).floor_height_m;
  for (int f = 0; f < clip.num_frames(); ++f) clip.root_position(f).y() -= floor;
  return clip;
}

// Poses with velocities.
std::vector<State> MakeStates(const motion::Clip& clip, const physics::HumanoidModel& model,
                              double cutoff_hz) {
  const int frames = clip.num_frames(), last = frames - 1;
  std::vector<State> states(frames);
  for (int f = 0; f < frames; ++f) {
    states[f].root_position = clip.root_position(f);
    std::ranges::copy(clip.pose(f), states[f].rotations.begin());
  }
  std::vector<Speeds> speeds(frames);
  for (int f = 0; f < frames; ++f) {
    const int a = std::max(f - 1, 0), b = std::min(f + 1, last);
    speeds[f] = Difference(states[a], states[b], (b - a) / clip.frame_rate());
  }
  for (int i = 1; i < kMaxBodies; ++i) {
    if (!model.articulation().bodies[i].rigid_joint) continue;
    for (Speeds& row : speeds) row.segment<3>(SpeedIndex(i)).setZero();
  }
  Filter(speeds, clip.frame_rate(), cutoff_hz);
  for (int f = 0; f < frames; ++f) states[f].speeds = speeds[f];
  return states;
}

std::vector<std::array<double, 2>> PlanFootLoads(const motion::Clip& clip,
                                                 const physics::HumanoidModel& model,
                                                 const ReferenceConfig& config) {
  std::vector<std::array<double, 2>> loads(clip.num_frames());
  std::array<FootTrack, 2> feet = TrackFeet(clip, model);
  const std::vector<char> flight = FindFlight(clip, model);
  for (int side = 0; side < 2; ++side) {
    FindContacts(flight, clip.frame_rate(), config.preparation, feet[side]);
    double left_s = config.unload_s;  // until it is lifted; at the end of the clip it stays
    for (int f = clip.num_frames() - 1; f >= 0; --f) {
      left_s = feet[side].standing[f] ? left_s + 1 / clip.frame_rate() : 0;
      loads[f][side] = std::min(left_s / std::max(config.unload_s, 1e-9), 1.0);
    }
  }
  return loads;
}

}  // namespace

StatusOr<ReferenceConfig> ReferenceConfig::FromPreset(std::string_view preset) {
  ReferenceConfig config;
  if (preset == "recommended") return config;
  if (preset != "paper") {
    return base::InvalidArgument(
        "UNKNOWN_PRESET", "preset",
        fmt::format("unknown preset '{}', expected recommended or paper", preset));
  }
  config.floor = "lowest";
  config.preparation.enabled = false;
  return config;
}

std::vector<base::Field> ReferenceConfig::Fields() {
  std::vector<base::Field> fields = {
      base::Number("velocity_cutoff_hz", &velocity_cutoff_hz, 0.1, 1000),
      base::Text("floor", &floor, {"still", "lowest", "median", "none"}),
      base::Number("flip_speed", &flip_speed, 1, 1e6),
      base::Number("flip_longest_s", &flip_longest_s, 0, 10),
  };
  fields.push_back(base::Number("unload_s", &unload_s, 0, 10));
  base::Append(fields, base::Nested("preparation", preparation.Fields()));
  return fields;
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
  motion::Clip aligned = PutOnFloor(clip, model, config.floor);
  motion::Clip repaired = aligned;
  RepairFlips(config, repaired);
  ReferenceMotion motion(std::move(aligned), PrepareMotion(repaired, model, config.preparation));
  motion.source_frames_ = MakeStates(repaired, model, config.velocity_cutoff_hz);
  motion.frames_ = MakeStates(motion.clip_, model, config.velocity_cutoff_hz);
  motion.foot_loads_ = PlanFootLoads(motion.clip_, model, config);
  const int last = motion.num_frames() - 1;
  for (int f = 0; f <= last; ++f) {
    const int a = std::max(f - 1, 0), b = std::min(f + 1, last);
    motion.accelerations_.push_back((motion.frames_[b].speeds - motion.frames_[a].speeds) *
                                    (motion.frame_rate() / (b - a)));
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

Vec3 ReferenceMotion::SourceRootAt(double time_s) const {
  const double position = std::clamp(time_s * frame_rate(), 0.0, num_frames() - 1.0);
  const int before = std::min(static_cast<int>(position), num_frames() - 2);
  const double u = position - before;
  return (1 - u) * source_clip_.root_position(before) + u * source_clip_.root_position(before + 1);
}

std::array<double, 2> ReferenceMotion::FootLoads(double time_s) const {
  const int frame = static_cast<int>(std::max(time_s, 0.0) * frame_rate());
  return foot_loads_[std::min(frame, num_frames() - 1)];
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
