#include "core/motion/metrics/plausibility.h"

#include <fmt/format.h>

#include <limits>

#include "core/motion/kinematics/sole_estimate.h"
#include "core/motion/metrics/floor_contact.h"
#include "core/motion/metrics/self_penetration.h"
#include "core/motion/metrics/smoothness.h"

namespace poise::motion {
namespace {

constexpr int kFewestFrames = 4;  // a third difference needs four

// Fresh pages cost more than the measures themselves, so each thread keeps its memory between
// clips, unless a clip was long.
struct Workspace {
  static constexpr size_t kMostPositionsKept = 100'000;

  WorldPoses world;
  PlacedBodies bodies;

  void Trim() {
    if (world.positions.size() > kMostPositionsKept) *this = Workspace();
  }
};

Status Check(const Clip& clip, const PlausibilityConfig& config) {
  POISE_RETURN_IF_ERROR(base::CheckRanges(PlausibilityConfig(config).Fields()));
  if (clip.num_frames() >= kFewestFrames) return absl::OkStatus();
  return base::FailedPrecondition(
      "CLIP_TOO_SHORT", "clip",
      fmt::format("clip '{}' has {} frames, plausibility needs at least {}", clip.name(),
                  clip.num_frames(), kFewestFrames));
}

// From the bodies placed in the workspace, which it trims.
Plausibility Assess(const BodyShapes& shapes, const FloorContact& contact, double frame_rate,
                    Workspace& workspace) {
  Plausibility plausibility;
  plausibility.foot_skate_mps = contact.foot_skate_mps;
  plausibility.penetration_mean_m = contact.penetration_mean_m;
  plausibility.penetration_max_m = contact.penetration_max_m;
  plausibility.float_mean_m = contact.float_mean_m;
  plausibility.self_penetration_max_m = WorstSelfPenetration(shapes, workspace.bodies);
  plausibility.acceleration_rms_mps2 = AccelerationRms(workspace.world, frame_rate);
  plausibility.jerk_rms_mps3 = JerkRms(workspace.world, frame_rate);
  workspace.Trim();
  return plausibility;
}

}  // namespace

std::vector<base::Field> PlausibilityConfig::Fields() {
  return {base::Number("contact_height_m", &contact_height_m, 1e-4, 1),
          base::Number("still_speed_mps", &still_speed_mps, 1e-4, 100),
          base::Number("floor_band_m", &floor_band_m, 1e-4, 10)};
}

std::vector<base::Field> Plausibility::Fields() {
  constexpr double kAny = std::numeric_limits<double>::max();
  return {
      base::Number("foot_skate_mps", &foot_skate_mps, -kAny, kAny),
      base::Number("penetration_mean_m", &penetration_mean_m, -kAny, kAny),
      base::Number("penetration_max_m", &penetration_max_m, -kAny, kAny),
      base::Number("float_mean_m", &float_mean_m, -kAny, kAny),
      base::Number("self_penetration_max_m", &self_penetration_max_m, -kAny, kAny),
      base::Number("acceleration_rms_mps2", &acceleration_rms_mps2, -kAny, kAny),
      base::Number("jerk_rms_mps3", &jerk_rms_mps3, -kAny, kAny),
  };
}

base::Json ToJson(const Plausibility& plausibility) {
  Plausibility copy = plausibility;
  return base::FieldsToJson(copy.Fields());
}

StatusOr<Plausibility> AssessPlausibility(const Clip& clip, const JointRoles& roles,
                                          const PlausibilityConfig& config) {
  POISE_RETURN_IF_ERROR(roles.RequireComplete());
  POISE_RETURN_IF_ERROR(Check(clip, config));
  thread_local Workspace workspace;
  ForwardKinematics(clip, 0, clip.num_frames(), workspace.world);
  const Skeleton& skeleton = *clip.skeleton();
  const Soles soles = EstimateSoles(skeleton, roles, workspace.world);
  POISE_ASSIGN_OR_RETURN(const BodyShapes shapes, MakeBodyShapes(skeleton, roles, soles));
  PlaceBodies(shapes, workspace.world, workspace.bodies);
  return Assess(shapes, MeasureFloorContact(workspace.bodies, clip.frame_rate(), config),
                clip.frame_rate(), workspace);
}

StatusOr<Plausibility> AssessPlausibility(const Clip& clip, const BodyShapes& shapes,
                                          double floor_height_m, const PlausibilityConfig& config) {
  POISE_RETURN_IF_ERROR(Check(clip, config));
  thread_local Workspace workspace;
  ForwardKinematics(clip, 0, clip.num_frames(), workspace.world);
  PlaceBodies(shapes, workspace.world, workspace.bodies);
  return Assess(
      shapes, MeasureContactWithFloor(workspace.bodies, clip.frame_rate(), floor_height_m, config),
      clip.frame_rate(), workspace);
}

}  // namespace poise::motion
